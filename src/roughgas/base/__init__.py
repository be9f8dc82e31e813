"""Errors, intervals of legal numbers, the version, optional packages."""

from collections.abc import Iterable
from importlib import import_module
from types import ModuleType
from typing import Any

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


class Interval:
    """An interval as text such as `[0, 1]` or `(0, inf)`; a round bracket leaves out the end."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.low, self.high = (float(end) for end in text[1:-1].split(","))

    def __str__(self) -> str:
        return self.text

    def holds(self, value: Any) -> Any:
        """Return whether `value`, or each element of an array, lies in the interval; NaN never."""
        above = value >= self.low if self.text[0] == "[" else value > self.low
        below = value <= self.high if self.text[-1] == "]" else value < self.high
        return above & below

    def check(self, key: str, value: Any) -> float:
        """Return `value` as a float; raise InputError where it is not a number in the interval."""
        if not self.holds(value):
            raise self.error(key, value)
        return float(value)

    def error(self, key: str, value: Any) -> InputError:
        """Return the error of a `value` outside the interval."""
        return InputError(key, value, self.legal)

    @property
    def legal(self) -> str:
        """The end of a message "it must ..."."""
        return f"lie in {self}"

    def schema(self) -> dict[str, Any]:
        """Return the interval as a JSON schema."""
        found: dict[str, Any] = {"type": "number"}
        found["minimum" if self.text[0] == "[" else "exclusiveMinimum"] = _plain(self.low)
        if self.high < float("inf"):
            found["maximum" if self.text[-1] == "]" else "exclusiveMaximum"] = _plain(self.high)
        return found


def _plain(number: float) -> int | float:
    return int(number) if number == int(number) else number


RESTITUTION = Interval("[0, 1]")
"""Normal restitution r."""
ROUGHNESS = Interval("[-1, 1]")
"""The roughness beta, from smooth (-1) to perfectly rough (1)."""


__version__ = "0.1.0"


EXTRAS = {
    "workflow": ("snakemake",),
    "figures": ("matplotlib",),
    "movies": ("imageio_ffmpeg",),
    "report": ("markdown_it", "jinja2"),
    "crate": ("rocrate",),
    "trajectories": ("gsd",),
}
"""The packages, as they are imported, that each extra brings."""


class MissingExtra(ImportError):
    """A package that an extra would bring is not installed; the text is one line."""


def required(module: str) -> ModuleType:
    """Return a module of a package that an extra brings. Raises MissingExtra."""
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        said = remedy(error)
        if said is None:
            raise
        raise MissingExtra(said, name=error.name) from error


def remedy(error: ImportError) -> str | None:
    """Return what to install where an extra is missing; None for other errors."""
    package = (error.name or "").partition(".")[0]
    extra = next((name for name, brought in EXTRAS.items() if package in brought), None)
    if extra is None or not isinstance(error, ModuleNotFoundError | MissingExtra):
        return None
    return f"{package} is not installed: pip install 'roughgas[{extra}]'"
