"""Optional packages, which extras install."""

from importlib import import_module
from types import ModuleType

EXTRAS = {
    "workflow": ("snakemake", "psutil"),
    "figures": ("matplotlib",),
    "movies": ("imageio_ffmpeg",),
    "report": ("markdown_it", "jinja2"),
    "crate": ("rocrate",),
    "article": ("typst",),
    "trajectories": ("gsd",),
    "dask": ("dask",),
}
"""Import names of the packages that each extra installs."""


class MissingExtra(ImportError):
    """A package of an extra is not installed; the text is one line."""


def import_extra(module: str) -> ModuleType:
    """Import and return a module of an optional package, given by its dotted name.

    Raises MissingExtra, which names the command to install it, if the package is not installed.
    """
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        advice = install_advice(error)
        if advice is None:
            raise
        raise MissingExtra(advice, name=error.name) from error


def install_advice(error: ImportError) -> str | None:
    """Return the message on a missing package of an extra, with the command to install the extra.

    It is None for other import errors.
    """
    package = (error.name or "").partition(".")[0]
    extra = next((name for name, packages in EXTRAS.items() if package in packages), None)
    if extra is None or not isinstance(error, ModuleNotFoundError | MissingExtra):
        return None
    return f"{package} is not installed: pip install 'roughgas[{extra}]'"
