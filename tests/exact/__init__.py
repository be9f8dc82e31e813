"""The same physics in fifty digits, and comparisons of it with the kernel."""

from exact.comparison import Segment, exactly, segment, separation
from exact.simulation import Event, Exact

__all__ = ["Event", "Exact", "Segment", "exactly", "segment", "separation"]
