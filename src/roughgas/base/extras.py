"""What roughgas can do without, and which extra of the package brings it.

`pip install roughgas` simulates. What else there is needs packages that an extra names, such as
`pip install 'roughgas[figures]'`; whoever lacks one is told so in a line.
"""

import sys
from importlib import import_module, util
from types import ModuleType

EXTRAS = {
    "workflow": ("snakemake", "snakemake_interface_logger_plugins"),
    "figures": ("matplotlib",),
    "movies": ("imageio_ffmpeg",),
    "report": ("markdown_it", "plotly"),
    "crate": ("rocrate",),
    "trajectories": ("gsd",),
}
"""The packages, as they are imported, that each extra brings."""


class MissingExtra(ImportError):
    """A package that an extra would bring is not installed; the text is one line."""


def missing() -> list[str]:
    """Return the extras of which a package is not installed."""
    return [name for name, brought in EXTRAS.items() if not all(map(_is_there, brought))]


def _is_there(package: str) -> bool:
    try:
        return util.find_spec(package) is not None
    except ValueError:  # of one that is imported, but has no spec
        return sys.modules[package] is not None


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
