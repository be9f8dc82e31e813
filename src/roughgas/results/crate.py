"""A finished run as an RO-Crate: what was run, by which code, in which environment, what came out.

The crate follows the Workflow Run RO-Crate profile 0.5 and is reproducible: the same files give the
same bytes. Points are listed, each with the command that makes it again and a digest of its
numbers; their files, a hundred times the size of the rest, are left out unless asked for.
"""

import csv
import hashlib
import io
import json
import os
import platform
import subprocess
import sys
import tempfile
import zipfile
import zlib
from collections.abc import Iterable, Mapping, Sequence
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from typing import Any

from roughgas.base.errors import InputError
from roughgas.base.files import whole_file
from roughgas.data.cf import SCHEMA_VERSION
from roughgas.data.point import WALL_CLOCK
from roughgas.results.crate_metadata import CONFIGURATION, ENVIRONMENT, POINTS, described, sha256

PROJECT = (
    *("CHANGELOG.md", "CITATION.cff", "LICENSE", "Makefile", "README.md", "Snakefile"),
    *("config.yaml", "pyproject.toml", "requirements.lock"),
)
FOLDERS = ("profiles", "rules", "src")
COLUMNS = ("point", "digest", "command")


def project_files(root: str | Path = ".") -> list[str]:
    """Return the files in `root` that a run of the workflow consists of, relative to it."""
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
    Raises InputError if a product is elsewhere, or the folder exists; OSError as files do.
    """
    output, products = Path(output), [_inside(product) for product in products]
    if output.suffix != ".zip" and output.exists():
        raise InputError("--output", output, "be a new folder, or end in .zip")
    points = [point for product in products for point in _points_of(product)]
    texts = {
        CONFIGURATION: json.dumps(configuration, indent=1, sort_keys=True) + "\n",
        ENVIRONMENT: json.dumps(environment(), indent=1) + "\n",
        POINTS: _list_of(points),
    }
    files = [*project_files(), *products, *(points if with_points else ())]
    crate = described(texts, files, products, _newest(products), commit())
    output.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=output.parent, prefix=f".{output.name}.") as folder:
        content = Path(folder) / "crate"
        crate.write(content)
        if output.suffix == ".zip":
            _pack(content, output)
        else:
            content.rename(output)


def verify(path: str | Path, points: Iterable[str | Path] = ()) -> list[str]:
    """Return what is wrong with a crate, a line each.

    That is files that are missing or have other checksums, and those of `points`, datasets that
    were made again, that have other numbers than all points in the crate. Raises InputError if
    `path` is no crate.
    """
    from rocrate.rocrate import ROCrate

    wrong = []
    try:
        crate = ROCrate(path)  # which unpacks it for a while
        expected = {file.source: file["sha256"] for file in crate.get_by_type("File")}
    except (ValueError, KeyError, OSError, zipfile.BadZipFile, zlib.error) as error:
        raise InputError("crate", path, "be an RO-Crate that roughgas wrote, whole") from error
    for file, checksum in expected.items():
        name = file.relative_to(crate.source)
        if not file.is_file():
            wrong.append(f"{name}: is missing")
        elif sha256(file.read_bytes()) != checksum:
            wrong.append(f"{name}: has changed")
    known = {row["digest"] for row in points_in(crate.source)}
    return wrong + [f"{one}: no point of the crate" for one in points if digest(one) not in known]


def points_in(crate: Path) -> list[dict[str, str]]:
    """Return the points that a crate in a folder lists, as dictionaries of COLUMNS."""
    with open(crate / POINTS, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def digest(path: str | Path) -> str:
    """Return a checksum of the numbers of a point, but for the time that they took.

    It is the same for the same point on any machine. Raises OSError if the file cannot be read.
    """
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
    """Return Python, the machine, and the version of every package that is installed."""
    packages = {one.metadata["Name"]: one.version for one in metadata.distributions()}
    return {
        "roughgas_schema_version": SCHEMA_VERSION,
        "python": sys.version,
        "platform": platform.platform(),
        "machine": platform.machine(),
        "packages": dict(sorted(packages.items(), key=lambda item: item[0].lower())),
    }


def commit() -> str | None:
    """Return the commit of the checkout that this folder is, marked if there are changes.

    None if it is no checkout, though it may be inside one.
    """
    command = ["git", "describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"]
    here = os.environ | {"GIT_CEILING_DIRECTORIES": str(Path.cwd().parent)}
    try:
        found = subprocess.run(command, capture_output=True, text=True, check=True, env=here)
    except (OSError, subprocess.CalledProcessError):
        return None
    return found.stdout.strip()


def _inside(product: str | Path) -> str:
    path = Path(product)
    if path.is_absolute() or ".." in path.parts:
        raise InputError("product", product, "be in this folder")
    return str(path)


def _newest(files: Iterable[str]) -> str:
    """Return the day on which the last of the files was made, or that of SOURCE_DATE_EPOCH."""
    seconds = os.environ.get("SOURCE_DATE_EPOCH") or max(os.path.getmtime(file) for file in files)
    return datetime.fromtimestamp(int(seconds), UTC).date().isoformat()


def _points_of(product: str) -> list[str]:
    folder = Path(product).with_suffix("")
    return sorted(str(path) for path in folder.rglob("seed*.nc")) if product.endswith(".nc") else []


def _list_of(points: Iterable[str]) -> str:
    """Return a row for each point: its file, the digest of its numbers, its command."""
    import netCDF4

    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(COLUMNS)
    for point in points:
        with netCDF4.Dataset(point) as file:
            table.writerow([point, digest(point), file.getncattr("command")])
    return text.getvalue()


def _pack(content: Path, output: Path) -> None:
    """Write a .zip of a folder without dates, sorted by name: the same for the same files."""
    with whole_file(output) as draft, zipfile.ZipFile(draft, "w") as archive:
        for path in sorted(path for path in content.rglob("*") if path.is_file()):
            entry = zipfile.ZipInfo(str(path.relative_to(content)))
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, path.read_bytes())
