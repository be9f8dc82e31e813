"""Standard output and error as they may be found: closed, or unable to write a beta."""

import os
import sys


def mend_streams() -> None:
    """Let all that is printed be printable: what a stream cannot encode becomes a question mark,
    and what goes to a closed one is lost."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:
            setattr(sys, name, open(os.devnull, "w"))
        else:
            stream.reconfigure(errors="replace")
