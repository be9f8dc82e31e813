"""Where compiled kernels are kept between runs.

Numba's disk cache notices an edit only in the file of the function that is looked up, not in the
files of the functions which that one calls: a kernel could outlive an edit and give yesterday's
numbers. The folder is therefore named by a hash of every source that machine code is made from.

The cache only saves time: where it is damaged kernels are compiled again, and where it cannot be
written they are compiled by each process.
"""

import fcntl
import hashlib
import os
import pickle
import sys
import tempfile
from contextlib import suppress
from pathlib import Path

from roughgas.base.errors import InputError

PACKAGE = Path(__file__).resolve().parent.parent
COMPILED_ROOMS = ("kernel", "effects", "studies/dsmc", "studies/soft_spheres")


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
    """Point numba's disk cache at the folder that belongs to these sources, and return it.

    Raises InputError where numba is told not to compile, OSError where no folder can be written.
    """
    import numba

    if numba.config.DISABLE_JIT:
        raise InputError("NUMBA_DISABLE_JIT", 1, "be unset: the kernels run compiled only")
    folder = kernel_folder()
    numba.config.CACHE_DIR = str(folder)
    return folder


def kernel_folder():
    """The folder of these sources' kernels, which is made where it is not there.

    ROUGHGAS_CACHE_DIR, then XDG_CACHE_HOME, then ~/.cache hold it; where that cannot be written (a
    read-only home), a folder of the system's temporary directory does. Raises OSError where that
    cannot be written either, or is somebody else's.
    """
    folder = cache_root() / f"kernels-{source_hash()}"
    try:
        _try_to_write(folder)
    except OSError:
        private = Path(tempfile.gettempdir()) / f"roughgas-{os.getuid()}"
        private.mkdir(mode=0o700, exist_ok=True)
        if private.stat().st_uid != os.getuid():  # who may write there may have us run anything
            raise PermissionError(None, "belongs to somebody else", str(private)) from None
        folder = private / folder.name
        _try_to_write(folder)
    return folder


def cache_root():
    """Where the folders of kernels are wanted, one for each state of the sources."""
    chosen = os.environ.get("ROUGHGAS_CACHE_DIR")
    if chosen:
        return Path(chosen)
    home = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    return Path(home) / "roughgas"


def _try_to_write(folder):
    folder.mkdir(parents=True, exist_ok=True)
    tempfile.TemporaryFile(dir=folder).close()


def load_without_compiler(dispatcher):
    """Have compiled code loaded from the disk without setting up the compiler before.

    Numba first imports and registers all that it can compile, which takes three times as long as
    loading. Where nothing is found in the cache, or nothing whole, compiling begins with that
    anyway.
    """
    from numba.core.runtime import rtsys

    cache = dispatcher._cache
    _seal_files(cache._cache_file)

    def load(signature, target):
        rtsys.initialize(target)  # which the loaded code takes its arguments apart with
        try:
            return cache._load_overload(signature, target)
        except Exception:  # a damaged pickle may raise whatever it likes
            with suppress(OSError):
                cache.flush()
            return None

    cache.load_overload = load


def _seal_files(files):
    """Have numba's files end with a checksum, and those without a right one taken for missing.

    Machine code with a hole in it, as a power cut leaves it, would crash every process to come.
    """
    dump = files._dump

    def dump_sealed(content):
        text = dump(content)  # a pickle, which does not mind what comes after it
        return text + hashlib.sha256(text).digest()

    def load_sealed(name):
        content = Path(files._data_path(name)).read_bytes()
        text, seal = content[:-32], content[-32:]
        if hashlib.sha256(text).digest() != seal:
            raise OSError("damaged")
        return pickle.loads(text)

    files._dump, files._load_data = dump_sealed, load_sealed


def one_writer_at_a_time(dispatcher):
    """Keep processes that compile at the same time from spoiling numba's index for each other.

    Numba reads its index, picks a free file number and writes both: two writers could pick the same
    number, and one of them would later load the other's code. Where nothing can be written (a full
    disk) the process goes on with what it has compiled, and says so.
    """
    cache = dispatcher._cache
    save = cache.save_overload

    def save_alone(signature, compiled):
        folder = Path(cache.cache_path)
        try:
            folder.mkdir(parents=True, exist_ok=True)
            with (folder / "lock").open("w") as lock:
                with suppress(OSError):  # some network disks have no locks
                    fcntl.flock(lock, fcntl.LOCK_EX)
                save(signature, compiled)
        except OSError as error:
            said = f"roughgas: warning: {folder}: {error.strerror}: the kernel is not kept"
            print(said, file=sys.stderr)

    cache.save_overload = save_alone
