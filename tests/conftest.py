"""What all tests share; its being here also lets them import `synthetic`."""

import signal

import pytest
from hypothesis import settings

# a shell's job in the background ignores Ctrl-C, and so would every process that tests start
signal.signal(signal.SIGINT, signal.default_int_handler)

# how long an example takes says nothing where compilers and other jobs share the cores
settings.register_profile("shared machine", deadline=None)
settings.load_profile("shared machine")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Tests of a file, which share what is costly to make, go to one worker (--dist loadgroup)."""
    for item in items:
        if item.get_closest_marker("xdist_group") is None:
            item.add_marker(pytest.mark.xdist_group(item.nodeid.partition("::")[0]))
