"""Folders, disks, memory and cores."""

import os
import shutil
import tempfile
from pathlib import Path

from roughgas.doctor.finding import OK, PROBLEM, WARNING, Finding

GIB = 2**30
RESULTS = 2 * GIB  # what everything that the workflow makes takes on the disk, generously
KERNELS = GIB // 4
COMPILER = GIB  # of memory
CHOOSE = "set ROUGHGAS_CACHE_DIR to a folder that can be written"


def kernel_cache() -> Finding:
    """Where compiled kernels are kept, and what older sources have left there."""
    from roughgas.kernel.cache import cache_root, kernel_folder

    wanted, folder = cache_root(), kernel_folder()
    said = f"{folder}, {_size([folder])}"
    if folder.parent != wanted:
        remedy = f"kernels are lost when temporary files are: {CHOOSE}"
        return Finding(WARNING, f"{wanted} cannot be written; instead {said}", remedy)
    if shutil.disk_usage(folder).free < KERNELS:
        return Finding(WARNING, f"{said}, on a disk that is nearly full", f"make room, or {CHOOSE}")
    if stale := stale_folders():
        said += f"; {len(stale)} folders of other versions, {_size(stale)}"
        return Finding(OK, f"{said} (`roughgas doctor --clean` removes them)")
    return Finding(OK, said)


def stale_folders() -> list[Path]:
    """The folders of kernels that belong to other sources than these."""
    from roughgas.kernel.cache import kernel_folder

    folder = kernel_folder()
    return [other for other in sorted(folder.parent.glob("kernels-*")) if other != folder]


def clean() -> str:
    """Remove the folders of other sources' kernels, which are compiled again where needed; says
    what has been gained. Raises OSError where one cannot be removed."""
    stale = stale_folders()
    said = f"{len(stale)} folders of kernels of other versions, {_size(stale)}: removed"
    for folder in stale:
        shutil.rmtree(folder)
    return said


def this_folder() -> Finding:
    """Whether results can be written here, and whether there is room for them."""
    return _room(Path.cwd(), RESULTS, "make it writable: results and figures are written here")


def temporary_files() -> Finding:
    """The same for the system's temporary files."""
    try:
        folder = Path(tempfile.gettempdir())
    except FileNotFoundError as error:
        return Finding(PROBLEM, error.strerror, "set TMPDIR to a folder that can be written")
    return _room(folder, GIB // 16, "set TMPDIR to another folder")


def cores_and_memory() -> Finding:
    """How many jobs at a time there is room for."""
    cores = len(os.sched_getaffinity(0))
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_AVPHYS_PAGES")
    said = f"{cores} cores, {memory / GIB:.1f} GiB of memory free"
    if memory < COMPILER:
        return Finding(WARNING, said, "a compiler takes 0.5 GiB: run one job at a time, -j1")
    return Finding(OK, said)


def slurm() -> Finding:
    """Whether jobs could be sent to a cluster from here."""
    sbatch = shutil.which("sbatch")
    return Finding(OK, sbatch or "there is none here; only clusters have it")


def _room(folder: Path, enough: int, remedy: str) -> Finding:
    free = shutil.disk_usage(folder).free
    said = f"{folder}, {free / GIB:.1f} GiB free"
    try:
        with tempfile.TemporaryFile(dir=folder) as file:
            file.write(b"room?" * 1000)
    except OSError as error:
        return Finding(PROBLEM, f"{folder} cannot be written: {error.strerror}", remedy)
    if free < enough:
        return Finding(WARNING, said, f"make room: {enough / GIB:.2g} GiB are enough")
    return Finding(OK, said)


def _size(folders: list[Path]) -> str:
    files = (file for folder in folders for file in folder.rglob("*") if file.is_file())
    return f"{sum(file.stat().st_size for file in files) / 2**20:.0f} MiB"
