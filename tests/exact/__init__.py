"""The same physics in fifty digits, and the means to run it beside the kernel."""

from exact.beside import Segment, exactly, segment, separation
from exact.simulation import Event, Exact

__all__ = ["Event", "Exact", "Segment", "exactly", "segment", "separation"]
