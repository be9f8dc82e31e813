"""A finished run as an RO-Crate: what was run, by which code, in which environment, what came out.

The crate follows the Workflow Run RO-Crate profile 0.5, and repeats itself: the same files give the
same bytes. Points are listed, with the command that makes each again and a digest of its numbers;
their files are left out unless asked for, since they take a hundred times the space of the rest.
"""

import csv
import hashlib
import io
import json
import os
import platform
import shutil
import subprocess
import sys
import tempfile
import zipfile
import zlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from typing import Any

from roughgas.base.errors import InputError
from roughgas.base.files import whole_file
from roughgas.data import cf
from roughgas.data.point import WALL_CLOCK
from roughgas.results import crate_metadata

PROJECT = (
    "CHANGELOG.md",
    "CITATION.cff",
    "LICENSE",
    "Makefile",
    "README.md",
    "Snakefile",
    "config.yaml",
    "pyproject.toml",
    "requirements.lock",
)
FOLDERS = ("profiles", "rules", "src")
CONFIGURATION, ENVIRONMENT, POINTS = "configuration.json", "environment.json", "points.csv"
COLUMNS = ("point", "digest", "command")


def project_files(root: str | Path = ".") -> list[str]:
    """The files in `root` that a run of the workflow consists of, relative to it."""
    root = Path(root)
    found = [root / name for name in PROJECT]
    for folder in FOLDERS:
        found += sorted(path for path in (root / folder).rglob("*.*") if path.suffix != ".pyc")
    return [str(path.relative_to(root)) for path in found]


def write_crate(
    products: Sequence[str | Path],
    output: str | Path,
    configuration: Mapping[str, Any],
    with_points: bool = False,
) -> None:
    """Write a crate of the project in this folder and its `products`, to a .zip or to a new folder.

    `products` (reduced datasets, tables, verdicts, figures) are paths relative to this folder. The
    points of results/paper/cooling.nc are those in results/paper/cooling/.
    Raises InputError where a product is elsewhere, or the folder exists; OSError as files do.
    """
    output, products = Path(output), [_inside(product) for product in products]
    if output.suffix != ".zip" and output.exists():
        raise InputError("--output", output, "be a new folder, or end in .zip")
    points = [point for product in products for point in _points_of(product)]
    made = {
        CONFIGURATION: json.dumps(configuration, indent=1, sort_keys=True) + "\n",
        ENVIRONMENT: json.dumps(environment(), indent=1) + "\n",
        POINTS: _list_of(points),
    }
    files = [*project_files(), *products, *(points if with_points else ())]
    output.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=output.parent, prefix=f".{output.name}.") as folder:
        content = Path(folder) / "crate"
        for name, text in made.items():
            _put(content / name, text)
        for name in files:
            (content / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(name, content / name)
        crate_metadata.write(content, products, _newest(products), commit())
        if output.suffix == ".zip":
            _pack(content, output)
        else:
            content.rename(output)


def verify(path: str | Path, points: Iterable[str | Path] = ()) -> list[str]:
    """What is wrong with a crate, a line each: files that miss or have other checksums; and which
    of `points`, datasets that were made again, have other numbers than all points in it.

    Raises InputError where `path` is no crate.
    """
    with _opened(path) as content:
        try:
            expected = crate_metadata.checksums(content)
        except (ValueError, KeyError, OSError) as error:
            raise InputError("crate", path, "be an RO-Crate that roughgas wrote") from error
        wrong = [
            f"{name}: {'is missing' if not (content / name).is_file() else 'has changed'}"
            for name, checksum in expected.items()
            if not (content / name).is_file() or crate_metadata.sha256(content / name) != checksum
        ]
        known = {row["digest"] for row in rows_of(content / POINTS)}
    return wrong + [f"{one}: no point of the crate" for one in points if digest(one) not in known]


def rows_of(path: Path) -> list[dict[str, str]]:
    """The points that a crate lists, as dictionaries of COLUMNS."""
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def digest(path: str | Path) -> str:
    """A checksum of the numbers in the dataset of a point, but for the time that they took: the
    same for the same point on any machine. Raises OSError where the file cannot be read."""
    import netCDF4

    found = hashlib.sha256()
    with netCDF4.Dataset(path) as file:
        file.set_auto_maskandscale(False)
        for name in sorted(set(file.variables) - set(WALL_CLOCK)):
            values = file[name][...]
            words = values.dtype == object
            content = "\0".join(values).encode() if words else values.tobytes()
            found.update(f"{name} {values.shape} ".encode() + content)
    return found.hexdigest()


def environment() -> dict[str, Any]:
    """Python, the machine, and the version of every package that is installed."""
    packages = {one.metadata["Name"]: one.version for one in metadata.distributions()}
    return {
        "roughgas_schema_version": cf.SCHEMA_VERSION,
        "python": sys.version,
        "platform": platform.platform(),
        "machine": platform.machine(),
        "packages": dict(sorted(packages.items(), key=lambda item: item[0].lower())),
    }


def commit() -> str | None:
    """The commit of the checkout in this folder, marked where it has been changed; None in no
    checkout."""
    command = ["git", "describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"]
    try:
        top = ["git", "rev-parse", "--show-prefix"]  # an empty line where this folder is the top
        inside = subprocess.run(top, capture_output=True, text=True, check=True).stdout.strip()
        found = subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return None
    return None if inside else found


def _inside(product):
    path = Path(product)
    if path.is_absolute() or ".." in path.parts:
        raise InputError("product", product, "be in this folder")
    return str(path)


def _newest(files: Iterable[str]) -> str:
    """The day on which the last of the files was made, or that of SOURCE_DATE_EPOCH."""
    seconds = os.environ.get("SOURCE_DATE_EPOCH") or max(os.path.getmtime(file) for file in files)
    return datetime.fromtimestamp(int(seconds), UTC).date().isoformat()


@contextmanager
def _opened(path: str | Path) -> Iterator[Path]:
    """The folder that a crate is, or that it is unpacked into for a while."""
    if Path(path).is_dir():
        yield Path(path)
        return
    with tempfile.TemporaryDirectory() as folder:
        try:
            with zipfile.ZipFile(path) as archive:
                archive.extractall(folder)
        except (zipfile.BadZipFile, zlib.error) as error:
            raise InputError("crate", path, "be an RO-Crate, whole") from error
        yield Path(folder)


def _points_of(product: str) -> list[str]:
    folder = Path(product).with_suffix("")
    return sorted(str(path) for path in folder.rglob("seed*.nc")) if product.endswith(".nc") else []


def _list_of(points: Iterable[str]) -> str:
    """A row for each point: its file, the digest of its numbers, the command that makes it."""
    import netCDF4

    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(COLUMNS)
    for point in points:
        with netCDF4.Dataset(point) as file:
            command = file.getncattr("command")
        table.writerow([point, digest(point), command])
    return text.getvalue()


def _put(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def _pack(content: Path, output: Path) -> None:
    """A .zip of a folder, without dates and in the order of names: the same for the same files."""
    with whole_file(output) as draft, zipfile.ZipFile(draft, "w") as archive:
        for path in sorted(path for path in content.rglob("*") if path.is_file()):
            entry = zipfile.ZipInfo(str(path.relative_to(content)))
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, path.read_bytes())
