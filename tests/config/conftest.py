from pathlib import Path

import pytest

from roughgas import config
from roughgas.base import InputError


@pytest.fixture(scope="session")
def paper():
    """The project's configuration, which no test changes."""
    return config.load(Path(__file__).parents[1] / "experiments.yaml")


@pytest.fixture(scope="session")
def refusal():
    """A function that calls another one, and returns the one line in which that refuses."""

    def message(function, *arguments):
        with pytest.raises(InputError) as caught:
            function(*arguments)
        assert "\n" not in str(caught.value)
        return str(caught.value)

    return message
