"""What all tests share; its being here also lets them import `synthetic`."""

import os
import signal
from pathlib import Path

from hypothesis import settings

# sums by several threads have other last bits; the command `roughgas` has one thread, too
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# a shell's job in the background ignores Ctrl-C, and so would every process that tests start
signal.signal(signal.SIGINT, signal.default_int_handler)

# how long an example takes says nothing where compilers and other jobs share the cores
settings.register_profile("shared machine", deadline=None)
settings.load_profile("shared machine")

SHORT = {"base", "claims", "config", "data", "planning", "results", "scene", "statistics", "theory"}
"""Folders in which no file takes more than some seconds."""


def pytest_collection_modifyitems(items):
    """Leave these to the end, where a long file would keep one worker busy and the other idle."""
    root = Path(__file__).parent
    items.sort(key=lambda item: item.path.relative_to(root).parts[0] in SHORT)
