"""Checks of an installation: `roughgas doctor`.

A check returns a report, or raises an exception; the text beside it in CHECKS is then the remedy.
Packages that may be broken are not imported at the top.
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

from roughgas.base import EXTRAS, __version__
from roughgas.base.files import check_writable

REQUIRED_LIBRARIES = "numpy numba netCDF4 xarray pandas ruamel.yaml jsonschema tqdm"
TRIAL_PROGRAM = """
from roughgas import simulate
from roughgas.config import SHIPPED
gas = simulate("cooling", r=0.9, beta=0.5, scale="small", config=SHIPPED, progress=False)
print(float(gas.R), float(gas.R_stderr))
"""
EXPECTED_RATIO = 0.4453  # R of that gas
TRIAL_TIMEOUT = 600  # seconds, enough for a slow and busy machine


def print_checks(in_json: bool) -> None:
    """Print the results of all CHECKS, a line for each, or as a JSON object with `in_json`.

    Exits with status 1 if a check has found a problem.
    """
    reports = {}
    for name, (check, remedy) in CHECKS.items():
        try:
            reports[name] = {"ok": True, "said": check()}
        except Exception as error:  # whatever a broken library raises
            message = " ".join(f"{type(error).__name__}: {error}".split())
            reports[name] = {"ok": False, "said": f"{message} -> {remedy}"}
        if not in_json:
            print(
                f"{'ok' if reports[name]['ok'] else 'problem':8} {name:14} {reports[name]['said']}"
            )
    if in_json:
        print(json.dumps(reports, indent=2))
    if not all(report["ok"] for report in reports.values()):
        raise SystemExit(1)


def _libraries() -> str:
    """Import the required libraries; return the versions of these, of roughgas and of Python."""
    names = REQUIRED_LIBRARIES.split()
    list(map(import_module, names))
    versions = (f"{name} {metadata.version(name)}" for name in names)
    python = f"Python {platform.python_version()}, {platform.machine()}: {sys.executable}"
    return f"roughgas {__version__}, from {Path(__file__).parent}; {python}; {', '.join(versions)}"


def _extras() -> str:
    """Return the names of the extras whose packages can be imported, and of the missing extras."""
    missing = []
    for name, packages in EXTRAS.items():
        try:
            list(map(import_module, packages))
        except ModuleNotFoundError:
            missing.append(name)
    installed = ", ".join(name for name in EXTRAS if name not in missing)
    return f"{installed or 'none'}; not installed: {', '.join(missing) or 'none'}"


def _configuration() -> str:
    """Load the active configuration; return its path and its number of experiments."""
    from roughgas import config

    path = config.active_config_path()
    return f"{path.absolute()}, with {len(config.load(path).experiments)} experiments"


def _kernel() -> str:
    """Run TRIAL_PROGRAM in a separate process, which may crash, and check its R; return a report.

    R is the share of rotation in the energy. Raises RuntimeError for a crash, and for an R that
    differs from EXPECTED_RATIO by five standard errors or more.
    """
    command = [sys.executable, "-c", TRIAL_PROGRAM]
    process = subprocess.run(command, capture_output=True, text=True, timeout=TRIAL_TIMEOUT)
    if process.returncode:
        lines = process.stderr.strip().splitlines() or [f"signal {-process.returncode}"]
        raise RuntimeError(f"a trial run crashed: {lines[-1]}")
    R, error = map(float, process.stdout.split())
    if not abs(R - EXPECTED_RATIO) < 5 * error:
        raise RuntimeError(f"a trial run has R = {R:.4f}({error:.1g}), not {EXPECTED_RATIO}")
    return f"R = {R:.4f} as on other machines"


def _kernel_cache() -> str:
    """Check that compiled kernels can be kept in the cache folder; return a report on it.

    Raises OSError if they would go to a temporary folder, or if the disk is full.
    """
    from roughgas.compiling.cache_folders import cache_root, kernel_folder

    if (folder := kernel_folder()).parent != cache_root():
        raise OSError(f"{cache_root()} cannot be written; kernels are lost, in {folder}")
    return _check_room(folder)


def _check_room(folder: str | Path, required_gib: float = 0.2) -> str:
    """Write a test file to a folder; return a report on its free space.

    Raises OSError if fewer than `required_gib` GiB (2^30 bytes) are free, or if nothing can be
    written.
    """
    with tempfile.TemporaryFile(dir=folder) as file:
        file.write(b"room?" * 1000)
    if (free := shutil.disk_usage(folder).free / 2**30) < required_gib:
        raise OSError(f"{folder}: only {free:.2g} GiB free")
    return f"{folder}, {free:.1f} GiB free"


def _snakemake() -> str:
    """Return the folder of Snakemake's cache; raise OSError if it cannot be written."""
    folder = Path(os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"))
    check_writable(folder / "snakemake")
    return f"its cache goes to {folder}"


REINSTALL = "install anew: `rm -r .venv` and `make setup` in the project's folder"
CHECKS = {
    "libraries": (_libraries, REINSTALL),
    "extras": (_extras, REINSTALL),
    "configuration": (_configuration, "correct config.yaml, or work in another folder"),
    "kernel": (_kernel, "remove the kernels, or set ROUGHGAS_CACHE_DIR to another folder"),
    "kernel cache": (_kernel_cache, "set ROUGHGAS_CACHE_DIR to a folder with room"),
    "Snakemake": (_snakemake, "set XDG_CACHE_HOME to a folder with room"),
    "this folder": (lambda: _check_room(Path.cwd(), 2.0), "make room for results"),
    "temporary files": (
        lambda: _check_room(tempfile.gettempdir()),
        "set TMPDIR to a folder with room",
    ),
}
