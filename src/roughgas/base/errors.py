"""Errors of bad input, and of a simulation."""

from collections.abc import Iterable

LONGEST = 60  # characters of a value in a message
SIMILAR = 0.8  # from 0 to 1: how alike a name must be to one that is suggested instead


class InputError(ValueError):
    """An illegal value: `key` names it, `legal` completes the sentence "it must ...".

    Its text is one line: `restitution r = 1.5: must lie in [0, 1]`.
    """

    def __init__(self, key: str, value: object, legal: str) -> None:
        super().__init__(key, value, legal)
        self.key = key
        self.value = value
        self.legal = legal

    def __str__(self) -> str:
        return f"{self.key} = {self.value}: must {self.legal}"


class NeedsError(InputError):
    """A setting without another one that it needs, `needed`; its text: `effects.gravity needs a
    floor`."""

    def __init__(self, key: str, needed: str) -> None:
        super().__init__(key, "alone", f"come with {needed}")
        self.needed = needed

    def __str__(self) -> str:
        return f"{self.key} needs {self.needed}"


def shown(value: object) -> str:
    """Return a value as a message quotes it: as Python writes it, on one line, not too long."""
    text = " ".join(repr(value).split())
    return text if len(text) <= LONGEST else text[: LONGEST - 3] + "..."


def on_one_line(text: str) -> str:
    """Return a text with newlines, and all else that cannot be printed, as Python writes them."""
    return "".join(sign if sign.isprintable() else repr(sign)[1:-1] for sign in text)


def not_one_of(key: str, value: object, known: Iterable[str]) -> InputError:
    """Return the error of a value that is not among the `known` ones, with a suggestion."""
    import difflib

    known = list(known)
    legal = f"be one of {', '.join(known)}"
    meant = difflib.get_close_matches(str(value).strip("'"), known, 1, SIMILAR)
    return InputError(key, value, f"{legal}; did you mean {meant[0]}?" if meant else legal)


class EndedEarlyError(RuntimeError):
    """A run that ended before it had made what was asked of it. Its text is one line."""


class CollapseError(EndedEarlyError):
    """Inelastic collapse: infinitely many contacts in a finite time."""


class JammedError(CollapseError):
    """A gas so dense that time hardly goes on."""


class SilentError(EndedEarlyError):
    """A gas so dilute, or so slow, that the collisions that were asked for do not come."""
