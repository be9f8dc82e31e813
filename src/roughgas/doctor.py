"""What is wrong with an installation: `roughgas doctor`.

A check returns what it has seen, or raises; the second text in CHECKS is what to do then. Nothing
is imported at the top that may be what is broken.
"""

import json
import os
import platform
import shutil
import subprocess
import sys
import tempfile
from importlib import import_module, metadata
from pathlib import Path

from roughgas.base.extras import EXTRAS
from roughgas.base.files import check_place
from roughgas.base.version import __version__

LIBRARIES = "numpy numba netCDF4 xarray pandas ruamel.yaml jsonschema tqdm"
TRIAL = """
from roughgas import simulate
gas = simulate("cooling", r=0.9, beta=0.5, scale="small", config={config!r}, progress=False)
print(float(gas.R), float(gas.R_stderr))
"""
KNOWN = 0.4453  # R of that gas
LONGEST = 600  # seconds to compile, on a machine that is slow and busy
ENOUGH = 2.0  # GiB


def doctor(as_json: bool) -> None:
    """Print what is wrong with the installation; exit with status 1 if there is a problem."""
    found = {}
    for name, (check, remedy) in CHECKS.items():
        try:
            found[name] = {"ok": True, "said": check()}
        except Exception as error:  # whatever a broken library raises
            said = " ".join(f"{type(error).__name__}: {error}".split())
            found[name] = {"ok": False, "said": f"{said} -> {remedy}"}
        if not as_json:
            print(f"{'ok' if found[name]['ok'] else 'problem':8} {name:14} {found[name]['said']}")
    if as_json:
        print(json.dumps(found, indent=2))
    if not all(one["ok"] for one in found.values()):
        raise SystemExit(1)


def _libraries() -> str:
    """Import all that roughgas needs."""
    for name in LIBRARIES.split():
        import_module(name)
    versions = (f"{name} {metadata.version(name)}" for name in LIBRARIES.split())
    python = f"Python {platform.python_version()}, {platform.machine()}: {sys.executable}"
    return f"roughgas {__version__}, from {Path(__file__).parent}; {python}; {', '.join(versions)}"


def _extras() -> str:
    """Import what extras have brought."""
    there, lacking = [], []
    for name, brought in EXTRAS.items():
        try:
            list(map(import_module, brought))
            there.append(name)
        except ModuleNotFoundError:
            lacking.append(name)
    return f"{', '.join(there) or 'none'}; not installed: {', '.join(lacking) or 'none'}"


def _configuration() -> str:
    """Check the configuration that commands use here."""
    from roughgas import config

    path = config.in_use()
    return f"{path.absolute()}, with {len(config.load(path)['experiments'])} experiments"


def _kernel() -> str:
    """Compile, or load, a kernel in a process of its own, which may crash, and compare its R."""
    from roughgas.config import SHIPPED

    ran = subprocess.run(
        [sys.executable, "-c", TRIAL.format(config=str(SHIPPED))],
        capture_output=True,
        text=True,
        timeout=LONGEST,
    )
    if ran.returncode:
        said = ran.stderr.strip().splitlines() or [f"signal {-ran.returncode}"]
        raise RuntimeError(f"a trial run crashed: {said[-1]}")
    R, error = map(float, ran.stdout.split())
    if not abs(R - KNOWN) < 5 * error:
        raise RuntimeError(f"a trial run has R = {R:.4f}({error:.1g}), not {KNOWN}")
    return f"R = {R:.4f} as on other machines"


def _kernel_cache() -> str:
    """Check that compiled kernels can be kept."""
    from roughgas.kernel.cache import cache_root, kernel_folder

    if (folder := kernel_folder()).parent != cache_root():
        raise OSError(f"{cache_root()} cannot be written; kernels are lost, in {folder}")
    return _room(folder)


def _room(folder: str | Path) -> str:
    """Check that a folder can be written, and has ENOUGH room."""
    with tempfile.TemporaryFile(dir=folder) as file:
        file.write(b"room?" * 1000)
    if (free := shutil.disk_usage(folder).free / 2**30) < ENOUGH:
        raise OSError(f"{folder}: only {free:.2g} GiB free")
    return f"{folder}, {free:.1f} GiB free"


def _snakemake() -> str:
    """Check that Snakemake can write its cache."""
    folder = Path(os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"))
    check_place(folder / "snakemake")
    return f"its cache goes to {folder}"


ANEW = "install anew: `rm -r .venv` and `make setup` in the project's folder"
CHECKS = {
    "libraries": (_libraries, ANEW),
    "extras": (_extras, ANEW),
    "configuration": (_configuration, "correct config.yaml, or work in another folder"),
    "kernel": (_kernel, "remove the kernels, or set ROUGHGAS_CACHE_DIR to another folder"),
    "kernel cache": (_kernel_cache, "set ROUGHGAS_CACHE_DIR to a folder with room"),
    "Snakemake": (_snakemake, "set XDG_CACHE_HOME to a folder with room"),
    "this folder": (lambda: _room(Path.cwd()), "make room for results"),
    "temporary files": (lambda: _room(tempfile.gettempdir()), "set TMPDIR to a folder with room"),
}
