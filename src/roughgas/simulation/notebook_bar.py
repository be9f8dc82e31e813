"""A progress bar for notebooks: a line of the output that changes in place, and ends empty.

tqdm's own bars go to stderr, which notebooks show in red, or need widgets.
"""

import io
from typing import Any

from IPython.display import display
from tqdm import tqdm

WIDTH = 100
"""Characters of a bar, with the text beside it."""


class NotebookBar(tqdm):
    """A bar of tqdm, as an output of the cell that runs."""

    def __init__(self, **settings: Any) -> None:
        """Begin a bar with the settings of tqdm; those of the stream and its width are ignored."""
        self._output = display({"text/plain": ""}, raw=True, display_id=True)
        settings |= {"file": io.StringIO(), "dynamic_ncols": False, "ncols": WIDTH}
        super().__init__(**settings)

    def display(self, msg: str | None = None, pos: int | None = None) -> None:
        """Show the bar, or the text `msg` in its place; `pos`, of stacked bars, is ignored."""
        if self._output is not None:  # as outside of a kernel
            text = str(self) if msg is None else msg
            self._output.update({"text/plain": text}, raw=True)
