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
from argparse import Namespace
from importlib import import_module, metadata
from pathlib import Path

from roughgas.base import EXTRAS, __version__
from roughgas.base.files import check_place

LIBRARIES = "numpy numba netCDF4 xarray pandas ruamel.yaml jsonschema tqdm"
TRIAL = """
from roughgas import simulate
from roughgas.config import SHIPPED
gas = simulate("cooling", r=0.9, beta=0.5, scale="small", config=SHIPPED, progress=False)
print(float(gas.R), float(gas.R_stderr))
"""
KNOWN = 0.4453  # R of that gas
LONGEST = 600  # seconds to compile, on a machine that is slow and busy


def doctor(options: Namespace) -> None:
    """Print what is wrong with the installation; exit with status 1 if there is a problem."""
    found = {}
    for name, (check, remedy) in CHECKS.items():
        try:
            found[name] = {"ok": True, "said": check()}
        except Exception as error:  # whatever a broken library raises
            said = " ".join(f"{type(error).__name__}: {error}".split())
            found[name] = {"ok": False, "said": f"{said} -> {remedy}"}
        if not options.json:
            print(f"{'ok' if found[name]['ok'] else 'problem':8} {name:14} {found[name]['said']}")
    if options.json:
        print(json.dumps(found, indent=2))
    if not all(one["ok"] for one in found.values()):
        raise SystemExit(1)


def _libraries() -> str:
    names = LIBRARIES.split()
    list(map(import_module, names))
    found = (f"{name} {metadata.version(name)}" for name in names)
    python = f"Python {platform.python_version()}, {platform.machine()}: {sys.executable}"
    return f"roughgas {__version__}, from {Path(__file__).parent}; {python}; {', '.join(found)}"


def _extras() -> str:
    lacking = []
    for name, brought in EXTRAS.items():
        try:
            list(map(import_module, brought))
        except ModuleNotFoundError:
            lacking.append(name)
    there = ", ".join(name for name in EXTRAS if name not in lacking)
    return f"{there or 'none'}; not installed: {', '.join(lacking) or 'none'}"


def _configuration() -> str:
    from roughgas import config

    path = config.in_use()
    return f"{path.absolute()}, with {len(config.load(path)['experiments'])} experiments"


def _kernel() -> str:
    """Run the trial in a process of its own, which may crash, and compare its R."""
    command = [sys.executable, "-c", TRIAL]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=LONGEST)
    if ran.returncode:
        said = ran.stderr.strip().splitlines() or [f"signal {-ran.returncode}"]
        raise RuntimeError(f"a trial run crashed: {said[-1]}")
    R, error = map(float, ran.stdout.split())
    if not abs(R - KNOWN) < 5 * error:
        raise RuntimeError(f"a trial run has R = {R:.4f}({error:.1g}), not {KNOWN}")
    return f"R = {R:.4f} as on other machines"


def _kernel_cache() -> str:
    from roughgas.compiling.compiler import cache_root, kernel_folder

    if (folder := kernel_folder()).parent != cache_root():
        raise OSError(f"{cache_root()} cannot be written; kernels are lost, in {folder}")
    return _room(folder)


def _room(folder: str | Path, enough: float = 0.2) -> str:
    """Write to a folder, and see whether `enough` GiB are free."""
    with tempfile.TemporaryFile(dir=folder) as file:
        file.write(b"room?" * 1000)
    if (free := shutil.disk_usage(folder).free / 2**30) < enough:
        raise OSError(f"{folder}: only {free:.2g} GiB free")
    return f"{folder}, {free:.1f} GiB free"


def _snakemake() -> str:
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
    "this folder": (lambda: _room(Path.cwd(), 2.0), "make room for results"),
    "temporary files": (lambda: _room(tempfile.gettempdir()), "set TMPDIR to a folder with room"),
}
