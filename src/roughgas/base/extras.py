"""What roughgas can do without, and which extra of the package brings it.

`pip install roughgas` simulates. What else there is needs packages that an extra names, such as
`pip install 'roughgas[figures]'`; whoever lacks one is told so in a line.
"""

from importlib import import_module
from types import ModuleType

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
