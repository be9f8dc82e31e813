"""Errors of input and of runs, with messages of one line."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

MAX_QUOTED_LENGTH = 60  # characters of a value in a message
MIN_SIMILARITY = 0.8  # least ratio (difflib, 0 to 1) of a legal name that is suggested


class InputError(ValueError):
    """An illegal value: `key` names it, `legal` completes the sentence "it must ...".

    Its text is one line, `KEY = VALUE: must LEGAL`, such as `restitution r = 1.5: must lie in [0,
    1]`.
    """

    def __init__(self, key: str, value: object, legal: str) -> None:
        """Store the key, the value as given (any type), and the legal values as text."""
        super().__init__(key, value, legal)
        self.key = key
        self.value = value
        self.legal = legal

    def __str__(self) -> str:
        """Return the error as one line."""
        return f"{self.key} = {self.value}: must {self.legal}"


class NeedsError(InputError):
    """A setting `key` that requires another one, `lacking_setting`, which is not given.

    Its text: `effects.gravity needs a floor`.
    """

    def __init__(self, key: str, lacking: str) -> None:
        """Store the key, and the name `lacking` of the setting that it requires."""
        super().__init__(key, "alone", f"come with {lacking}")
        self.lacking_setting = lacking

    def __str__(self) -> str:
        """Return the error as one line."""
        return f"{self.key} needs {self.lacking_setting}"


@contextmanager
def as_input_errors(source: str, legal: str) -> Iterator[None]:
    """Turn any exception of a user's code into an InputError that names its `source`.

    `legal` completes "it must ..."; an InputError keeps its value and its legal values.
    """
    try:
        yield
    except InputError as error:
        raise InputError(f"{source}: {error.key}", error.value, error.legal) from error
    except (Exception, SystemExit) as error:
        raise InputError(source, on_one_line(f"{type(error).__name__}: {error}"), legal) from error


def short_repr(value: object) -> str:
    """Return the repr of a value on one line, cut to MAX_QUOTED_LENGTH, for a message."""
    text = " ".join(repr(value).split())
    return text if len(text) <= MAX_QUOTED_LENGTH else text[: MAX_QUOTED_LENGTH - 3] + "..."


def on_one_line(text: str) -> str:
    """Return a text on one line, its newlines and unprintable characters as Python's escapes."""
    return "".join(sign if sign.isprintable() else repr(sign)[1:-1] for sign in text)


def unknown_name_error(key: str, value: object, legal_names: Iterable[str]) -> InputError:
    """Return the InputError of a `value` that is no legal name; it suggests the most similar name.

    `key` is the kind of the name, such as "experiment". Names of a similarity below MIN_SIMILARITY
    are not suggested.
    """
    import difflib

    legal_names = list(legal_names)
    legal = f"be one of {', '.join(legal_names)}"
    suggestions = difflib.get_close_matches(str(value).strip("'"), legal_names, 1, MIN_SIMILARITY)
    return InputError(
        key, value, f"{legal}; did you mean {suggestions[0]}?" if suggestions else legal
    )


def check_one_of(key: str, value: Any, legal_names: Iterable[str]) -> None:
    """Raise InputError if `value` is no legal name; `key` is its kind, such as "scale"."""
    if value not in legal_names:
        raise unknown_name_error(key, short_repr(value), sorted(legal_names))


class EndedEarlyError(RuntimeError):
    """A run that ended before its measurement was complete. Its text is one line."""


class CollapseError(EndedEarlyError):
    """Inelastic collapse: infinitely many contacts in a finite time."""


class JammedError(CollapseError):
    """A gas so dense that its events hardly advance time."""


class SilentError(EndedEarlyError):
    """A gas so dilute, or so slow, that the requested collisions do not occur."""
