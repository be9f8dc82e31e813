"""Python, the libraries, and where they come from."""

import importlib
import os
import platform
import struct
import sys
import sysconfig
from importlib import metadata, util
from pathlib import Path

from roughgas.base.version import __version__
from roughgas.doctor.finding import OK, PROBLEM, WARNING, Finding

ANEW = "install anew: `rm -r .venv` and `make setup` in the project's folder"
OLDEST = (3, 11)
PROMISED = ("x86_64", "AMD64")  # machines on which a seed gives the same bits
PACKAGE = Path(__file__).resolve().parent.parent
MODULES = (
    "numpy",
    "numba",
    "netCDF4",
    "xarray",
    "matplotlib",
    "yaml",
    "jsonschema",
    "emcee",
    "plotly",
    "rocrate",
    "tqdm",
    "imageio_ffmpeg",
    "snakemake",
)
CHANGES = "NUMBA_"  # how variables begin that change what is compiled
HARMLESS = ("NUMBA_CACHE_DIR", "NUMBA_NUM_THREADS")


def python() -> Finding:
    """Its version and the machine that it is made for."""
    bits = 8 * struct.calcsize("P")
    said = f"{platform.python_version()}, {bits} bit, {platform.machine()}: {sys.executable}"
    if sys.version_info < OLDEST or bits < 64:
        return Finding(PROBLEM, said, "take a Python of 64 bit, 3.11 or newer; then " + ANEW)
    if platform.machine() not in PROMISED:
        return Finding(WARNING, said, "works; but the last bits are promised on x86-64 alone")
    return Finding(OK, said)


def packages() -> Finding:
    """Whether all libraries can be imported, and are those of this environment."""
    strangers = []
    for name in MODULES:
        place = _place(name)
        if place is None:
            return Finding(PROBLEM, f"{name} is not installed", "`make setup`")
        if not _is_ours(place):
            strangers.append(place)
        try:
            importlib.import_module(name)
        except Exception as error:  # whatever its first lines may raise
            said = f"{name} cannot be imported from {place}: {' '.join(str(error).split())}"
            return Finding(PROBLEM, said, _how_to_import((*strangers, place)[0]))
    if strangers:
        said = f"not of this environment: {', '.join(map(str, strangers))}"
        return Finding(WARNING, said, _how_to_import(strangers[0]))
    return Finding(OK, f"{len(MODULES)} libraries can be imported")


def versions() -> Finding:
    """Whether what is installed is what requirements.lock pins."""
    lock = next((p for p in _locks() if p.exists()), None)
    if lock is None:
        return Finding(OK, "there is no requirements.lock here to compare with")
    pinned = read_lock(lock)
    others = [
        f"{name} {found or 'missing'} ({version} is pinned)"
        for name, version in pinned.items()
        if (found := _installed(name)) != version
    ]
    if others:
        few = ", ".join(others[:3]) + (f" and {len(others) - 3} more" if len(others) > 3 else "")
        return Finding(WARNING, few, f"for the pinned versions, {ANEW}")
    return Finding(OK, f"all {len(pinned)} as pinned in {lock}")


def package() -> Finding:
    """Which roughgas this is, and whether its sources are those of the folder one stands in."""
    said = f"{__version__}, from {PACKAGE}"
    here = Path("src/roughgas").resolve()
    if here.is_dir() and here != PACKAGE:
        remedy = "use the .venv of this folder: `make setup`, then .venv/bin/roughgas"
        return Finding(WARNING, f"{said}, not from this folder's {here}", remedy)
    return Finding(OK, said)


def environment() -> Finding:
    """Variables that change what is compiled."""
    found = [name for name in os.environ if name.startswith(CHANGES) and name not in HARMLESS]
    if found:
        said = ", ".join(f"{name}={os.environ[name]}" for name in sorted(found))
        return Finding(WARNING, said, f"speed and last bits may differ: unset {' '.join(found)}")
    return Finding(OK, "no variable changes what is compiled")


def read_lock(path: Path) -> dict[str, str]:
    """The versions that a lock file pins for this machine, by name."""
    from packaging.requirements import Requirement

    pinned = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        if line[:1].isalnum():
            wanted = Requirement(line.rstrip(" \\"))
            if wanted.marker is None or wanted.marker.evaluate():
                pinned[wanted.name] = str(wanted.specifier).removeprefix("==")
    return pinned


def _locks() -> list[Path]:
    return [PACKAGE.parent.parent / "requirements.lock", Path("requirements.lock").resolve()]


def _installed(name: str) -> str | None:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def _place(name: str) -> Path | None:
    """The file that `import name` would read."""
    found = util.find_spec(name)
    return None if found is None or found.origin is None else Path(found.origin)


def _is_ours(place: Path) -> bool:
    homes = [sysconfig.get_path(kind) for kind in ("purelib", "platlib")]
    return any(place.is_relative_to(home) for home in homes)


def _how_to_import(place: Path) -> str:
    if _is_ours(place):
        return ANEW
    return f"{place} stands before the library of this name: move it away, or unset PYTHONPATH"
