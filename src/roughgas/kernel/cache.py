"""Where compiled kernels are kept between runs.

Numba's disk cache notices an edit only in the file of the function that is looked up, not in the
files of the functions which that one calls: a kernel could outlive an edit and give yesterday's
numbers. The folder is therefore named by a hash of every source that machine code is made from.
"""

import fcntl
import hashlib
import os
import tempfile
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent
COMPILED_ROOMS = ("kernel", "effects", "dsmc", "soft_spheres")


def source_hash():
    """Hex digest over the sources that are compiled, and the versions of the compilers."""
    import llvmlite
    import numba

    digest = hashlib.sha256(f"numba {numba.__version__} llvmlite {llvmlite.__version__}".encode())
    for path in compiled_sources():
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def compiled_sources():
    """Every source file that shapes the machine code, in a fixed order."""
    return [p for room in COMPILED_ROOMS for p in sorted((PACKAGE / room).glob("*.py"))]


def use_source_keyed_folder():
    """Point numba's disk cache at the folder that belongs to these sources.

    ROUGHGAS_CACHE_DIR, then XDG_CACHE_HOME, then ~/.cache hold it; where none can be written (a
    read-only home), a folder of the system's temporary directory does.
    """
    import numba

    folder = _cache_root() / f"kernels-{source_hash()}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        writable = os.access(folder, os.W_OK)
    except OSError:
        writable = False
    if not writable:
        folder = Path(tempfile.gettempdir()) / f"roughgas-{os.getuid()}" / folder.name
        folder.mkdir(parents=True, exist_ok=True)
    numba.config.CACHE_DIR = str(folder)
    return folder


def load_without_compiler(dispatcher):
    """Have compiled code loaded from the disk without setting up the compiler before.

    Numba first imports and registers all that it can compile, which takes three times as long as
    loading. Where nothing is found in the cache, compiling begins with that anyway.
    """
    from numba.core.runtime import rtsys

    cache = dispatcher._cache

    def load(signature, target):
        rtsys.initialize(target)  # which the loaded code takes its arguments apart with
        return cache._load_overload(signature, target)

    cache.load_overload = load


def one_writer_at_a_time(dispatcher):
    """Keep processes that compile at the same time from spoiling numba's index for each other.

    Numba reads its index, picks a free file number and writes both: two writers could pick the same
    number, and one of them would later load the other's code.
    """
    cache = dispatcher._cache
    save = cache.save_overload

    def save_alone(signature, compiled):
        with (Path(cache.cache_path) / "lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            save(signature, compiled)

    cache.save_overload = save_alone


def _cache_root():
    chosen = os.environ.get("ROUGHGAS_CACHE_DIR")
    if chosen:
        return Path(chosen)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "roughgas"
