"""What all tests share; its being here also lets them import `synthetic`."""

import os
import signal

from hypothesis import settings

# sums by several threads have other last bits; the command `roughgas` has one thread, too
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# a shell's job in the background ignores Ctrl-C, and so would every process that tests start
signal.signal(signal.SIGINT, signal.default_int_handler)

# how long an example takes says nothing where compilers and other jobs share the cores
settings.register_profile("shared machine", deadline=None)
settings.load_profile("shared machine")


def pytest_collection_modifyitems(items):
    """Begin with the tests of workflows: those that follow share less, and workers may part them.

    Each worker that has one of these makes projects for itself, which takes many seconds.
    """
    items.sort(key=lambda item: "workflow" not in item.path.parts)
