"""Where compiled kernels are kept between runs.

Numba's disk cache notices an edit only in the file of the function that is looked up, not in the
files of the functions that it calls: a kernel could outlive an edit and give yesterday's numbers.
The folder is therefore named by a hash of every source that machine code is made from.

The cache only saves time: kernels that are damaged are compiled again, and where nothing can be
written each process compiles its own.

What is loaded is run: folders are made for their owner alone, and a folder or a file that somebody
else could have written is left alone.
"""

import hashlib
import os
import tempfile
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent
ROOMS = ("kernel", "effects")


def source_hash(*rooms):
    """Return a hex digest of the sources in these rooms, by default the kernel's, and of the
    versions of the compilers."""
    import llvmlite
    import numba

    digest = hashlib.sha256(f"numba {numba.__version__} llvmlite {llvmlite.__version__}".encode())
    for room in rooms or ROOMS:
        for path in sorted((PACKAGE / room).glob("*.py")):
            digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def kernel_folder():
    """Return the folder of these sources' kernels; make it where it does not exist.

    It is in ROUGHGAS_CACHE_DIR, or XDG_CACHE_HOME, or ~/.cache; where that cannot be written (a
    read-only home), or others can write there, in the system's temporary directory. Raises OSError
    where that holds there as well.
    """
    folder = cache_root() / f"kernels-{source_hash()}"
    try:
        _try_to_write(folder)
    except OSError:
        private = Path(tempfile.gettempdir()) / f"roughgas-{os.getuid()}"
        private.mkdir(mode=0o700, exist_ok=True)
        if not is_own(private):
            raise PermissionError(None, "belongs to somebody else", str(private)) from None
        folder = private / folder.name
        _try_to_write(folder)
    return folder


def folder_of(file):
    """Return the folder for the compiled functions of `file`, as `kernel_folder` does.

    Other rooms, and files outside the package, call the kernel's functions: they have folders in
    the kernel's, named by a hash of their own sources.
    """
    file = Path(file).resolve()
    if PACKAGE not in file.parents:
        own = hashlib.sha256(file.read_bytes()).hexdigest()[:16]
    elif file.parent.name in ROOMS:
        return kernel_folder() / file.stem
    else:
        own = source_hash(file.parent)
    return kernel_folder() / f"{file.stem}-{own}"


def cache_root():
    """Return where the folders of kernels should be, one for each state of the sources."""
    chosen = os.environ.get("ROUGHGAS_CACHE_DIR")
    if chosen:
        return Path(chosen)
    home = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    return Path(home) / "roughgas"


def is_own(path):
    """Return whether only the user, and root, can have written a file or folder."""
    about = os.stat(path)
    return about.st_uid in (os.getuid(), 0) and not about.st_mode & 0o022


def _try_to_write(folder):
    folder.parent.mkdir(parents=True, exist_ok=True)
    folder.mkdir(mode=0o700, exist_ok=True)
    if not is_own(folder):
        raise PermissionError(None, "can be written by others", str(folder))
    tempfile.TemporaryFile(dir=folder).close()
