"""Folders of compiled kernels, named by a hash of the sources that machine code is made from.

Numba's disk cache notices an edit only in the file of the function that is looked up, not in the
files of the functions that it calls: a kernel could outlive an edit and give yesterday's numbers.
A folder named by the hash of all sources cannot.

Loaded machine code is run: folders are made for their owner alone, and a folder or a file that
somebody else could have written is not used.
"""

import hashlib
import os
import sys
import tempfile
from importlib import metadata
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent
ROOMS = ("compiling", "kernel", "effects")


def source_hash(*rooms):
    """Return a hex digest of the sources in these rooms, by default the kernel's, and of the
    versions of the compilers."""
    versions = f"numba {metadata.version('numba')} llvmlite {metadata.version('llvmlite')}"
    digest = hashlib.sha256(versions.encode())
    for room in rooms or ROOMS:
        for path in sorted((PACKAGE / room).glob("*.py")):
            digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


SOURCE_HASH = source_hash()
"""Digest of the sources of this process: those on disk may have been edited since."""


def kernel_folder(suffix=""):
    """Return the folder `kernels-HASH` + suffix of these sources' kernels; make it if need be.

    It is in ROUGHGAS_CACHE_DIR, or XDG_CACHE_HOME, or ~/.cache; where that cannot be written (a
    read-only home), or others can write there, in the system's temporary directory. Raises OSError
    where that holds there as well.
    """
    folder = cache_root() / f"kernels-{SOURCE_HASH}{suffix}"
    try:
        _check_writable(folder)
    except OSError:
        private = Path(tempfile.gettempdir()) / f"roughgas-{os.getuid()}"
        private.mkdir(mode=0o700, exist_ok=True)
        if not is_safe(private):
            raise PermissionError(None, "belongs to somebody else", str(private)) from None
        folder = private / folder.name
        _check_writable(folder)
    return folder


def folder_of_file(file, suffix=""):
    """Return the folder for the compiled functions of a source file, within the `kernel_folder`.

    Files of other rooms, and outside of the package, have compiled functions, too, which call the
    kernel's and those of files in the same folder: theirs is named by a hash of all sources there.
    """
    file = Path(file).resolve()
    if PACKAGE in file.parents and file.parent.name in ROOMS:
        return kernel_folder(suffix) / file.stem
    return kernel_folder(suffix) / f"{file.stem}-{source_hash(file.parent)}"


def cache_root():
    """Return the folder of the folders of kernels, one for each state of the sources."""
    chosen = os.environ.get("ROUGHGAS_CACHE_DIR")
    if chosen:
        return Path(chosen)
    home = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    return Path(home) / "roughgas"


def is_safe(path):
    """Return whether nobody but the user, and root, can have written a file or folder."""
    status = os.stat(path)
    return status.st_uid in (os.getuid(), 0) and not status.st_mode & 0o022


def warn_not_kept(folder, error):
    """Print the warning that a folder cannot hold machine code, with the OSError's reason."""
    warning = f"roughgas: warning: {folder}: {error.strerror}: the kernel is not kept"
    print(warning, file=sys.stderr)


def _check_writable(folder):
    """Make a folder for its owner alone. Raises OSError where it cannot be, or is not so."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    folder.mkdir(mode=0o700, exist_ok=True)
    if not is_safe(folder):
        raise PermissionError(None, "can be written by others", str(folder))
    tempfile.TemporaryFile(dir=folder).close()
