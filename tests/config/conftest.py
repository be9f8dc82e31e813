import pytest
from tests.configurations import EXPERIMENTS

from roughgas import config
from roughgas.base import InputError


@pytest.fixture(scope="session")
def paper():
    """The project's configuration, which no test changes."""
    return config.load(EXPERIMENTS)


@pytest.fixture(scope="session")
def refusal():
    """A function that calls another one, and returns its refusal, a single line."""

    def message(function, *arguments):
        with pytest.raises(InputError) as caught:
            function(*arguments)
        assert "\n" not in str(caught.value)
        return str(caught.value)

    return message
