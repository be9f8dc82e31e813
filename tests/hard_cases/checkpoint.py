"""The checkpoint of a family: the finished cases of an interrupted run, which the next run uses.

The file holds cases with their margins, and blocks of scenes within a case. It belongs to the code
and the settings of its run: another run begins anew.
"""

import hashlib
import json
import os
from importlib import metadata
from pathlib import Path
from typing import Any

import roughgas
from roughgas.base.files import VERSIONS, write_text

TESTS, PACKAGE = Path(__file__).parent.parent, Path(roughgas.__file__).parent
LIBRARIES = ("numpy", "hypothesis", "mpmath")


class FinishedCases:
    """Finished cases and blocks by name, in a file, or only in memory if `path` is None."""

    def __init__(self, path: Path | None = None, key: str = "") -> None:
        self.path, self._key = path, key
        self._finished: dict[str, Any] = {}
        if path and path.exists():
            self._finished = self._read(path)

    def __contains__(self, name: str) -> bool:
        return name in self._finished

    def __getitem__(self, name: str) -> Any:
        """Return the result of a case or block. Raises KeyError."""
        return self._finished[name]

    def __setitem__(self, name: str, value: Any) -> None:
        """Store a result that JSON can hold, and write the file. Raises OSError."""
        self._finished[name] = value
        if self.path:
            content = {"key": self._key, "finished": self._finished}
            write_text(self.path, json.dumps(content, default=_python_number) + "\n")

    def remove(self) -> None:
        """Remove the file, whose run has ended."""
        if self.path:
            self.path.unlink(missing_ok=True)

    def _read(self, path: Path) -> dict[str, Any]:
        try:
            content = json.loads(path.read_text(encoding="utf-8"))
            if content["key"] == self._key:
                print(f"going on from {path}")
                return dict(content["finished"])
            print(f"{path} belongs to other code or settings: beginning anew")
        except (ValueError, KeyError, TypeError):
            print(f"{path} is damaged: beginning anew")
        return {}


def _python_number(number: Any) -> Any:
    """Return a number of numpy as a number of Python."""
    return number.item()


def run_key(*settings: object) -> str:
    """Return a hash of settings and of all code that the margins may depend on."""
    versions = [f"{library} {metadata.version(library)}" for library in LIBRARIES]
    digest = hashlib.sha256(repr((settings, VERSIONS, versions)).encode())
    for path in _source_files():
        digest.update(f"{path.name}\n".encode() + path.read_bytes())
    return digest.hexdigest()


def _source_files() -> list[Path]:
    """Return the files of the package, and the files of the tests that families import or read."""
    package = [path for kind in ("*.py", "*.yaml") for path in PACKAGE.rglob(kind)]
    shared = [path for path in TESTS.glob("*.py") if not path.name.startswith("test_")]
    for folder in ("brute_force", "exact", "hard_cases"):
        shared += [
            path for kind in ("py", "yaml", "json") for path in (TESTS / folder).glob(f"*.{kind}")
        ]
    return sorted(
        [*package, *shared, *Path().glob("config.yaml")]
    )  # which a case reads from the working folder


class Lines:
    """A stream of lines to a file descriptor, printed above the progress bar of another process."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor
        self._clear = "\r\033[K" if os.isatty(descriptor) else ""

    def isatty(self) -> bool:
        """Return False, so that lines are written: bars of two processes overwrite each other."""
        return False

    def write(self, text: str) -> None:
        """Write a text. Raises OSError if nobody reads it."""
        os.write(self._descriptor, ((self._clear if text.strip() else "") + text).encode())

    def flush(self) -> None:
        """Do nothing: text is written at once."""
