"""A finished run as an RO-Crate: what was run, by which code, in which environment, what came out.

The crate follows the Workflow Run RO-Crate profile 0.5 and is reproducible: the same files give the
same bytes. Points are listed, each with the command that makes it again and a digest of its
numbers; their files, a hundred times the size of the rest, are left out unless asked for.
"""

import csv
import hashlib
import io
import json
import mimetypes
import os
import tempfile
import zipfile
import zlib
from collections.abc import Iterable, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roughgas.base.errors import InputError
from roughgas.base.files import whole_file
from roughgas.base.layout import in_csv
from roughgas.base.version import __version__
from roughgas.config.reading import read_yaml
from roughgas.data.opening import POINT, opened
from roughgas.data.point import WALL_CLOCK
from roughgas.results.origin import agent, commit, environment

if TYPE_CHECKING:
    from rocrate.rocrate import ROCrate

PROJECT = (
    *("CHANGELOG.md", "CITATION.cff", "LICENSE", "Makefile", "README.md", "Snakefile"),
    *("config.yaml", "pyproject.toml", "requirements.lock"),
)
FOLDERS = ("profiles", "rules", "src")
COLUMNS = ("point", "digest", "command")
PROFILES = {
    "https://w3id.org/ro/wfrun/process/0.5": "Process Run Crate",
    "https://w3id.org/ro/wfrun/workflow/0.5": "Workflow Run Crate",
    "https://w3id.org/workflowhub/workflow-ro-crate/1.0": "Workflow RO-Crate",
}
WORKFLOW = "Snakefile"
CONFIGURATION, ENVIRONMENT, POINTS = "configuration.json", "environment.json", "points.csv"
MEANINGS = {
    CONFIGURATION: "the configuration that the run had, with what its command line changed",
    ENVIRONMENT: "Python, the machine, and the version of every package installed",
    POINTS: "each point simulated: a digest of its numbers, the command that makes it again",
    "config.yaml": "every experiment as data",
    "requirements.lock": "the pinned environment",
    WORKFLOW: "the workflow",
}


def project_files(root: str | Path = ".") -> list[str]:
    """Return the files in `root` that a run of the workflow consists of, relative to it."""
    found = list(PROJECT)
    for files in (sorted(Path(root, folder).rglob("*.*")) for folder in FOLDERS):
        found += [str(path.relative_to(root)) for path in files if path.suffix != ".pyc"]
    return found


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
    output, made = Path(output), [str(product) for product in products]
    if missing := [name for name in PROJECT if not Path(name).is_file()]:
        legal = (
            f"be one with the workflow, such as a clone of the repository: {missing[0]} is missing"
        )
        raise InputError("folder", Path.cwd(), legal)
    for product in made:
        if Path(product).is_absolute() or ".." in Path(product).parts:
            raise InputError("product", product, "be in this folder")
    if output.suffix != ".zip" and output.exists():
        raise InputError("--output", output, "be a new folder, or end in .zip")
    points = []
    for folder in (Path(name).with_suffix("") for name in made if name.endswith(".nc")):
        points += sorted(map(str, folder.rglob("seed*.nc")))
    texts = {
        CONFIGURATION: json.dumps(configuration, indent=1, sort_keys=True) + "\n",
        ENVIRONMENT: json.dumps(environment(), indent=1) + "\n",
        POINTS: _list_of(points),
    }
    files = [*project_files(), *made, *(points if with_points else ())]
    crate = _described(texts, files, made)
    output.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=output.parent, prefix=f".{output.name}.") as draft:
        content = Path(draft) / "crate"
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
    except (ValueError, TypeError, LookupError, OSError, zipfile.BadZipFile, zlib.error) as error:
        raise InputError("crate", path, "be an RO-Crate that roughgas wrote, whole") from error
    for file, checksum in expected.items():
        name = file.relative_to(crate.source)
        if not file.is_file():
            wrong.append(f"{name}: is missing")
        elif _sha256(file.read_bytes()) != checksum:
            wrong.append(f"{name}: has changed")
    known = {row.get("digest") for row in points_in(crate.source)}
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


def _list_of(points: Iterable[str]) -> str:
    """Return a row for each point: its file, the digest of its numbers, its command."""
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(COLUMNS)
    for point in points:
        with opened(point, POINT) as file:
            table.writerow(map(in_csv, [point, digest(point), file.getncattr("command")]))
    return text.getvalue()


def _pack(content: Path, output: Path) -> None:
    """Write a .zip of a folder without dates, sorted by name: the same for the same files."""
    with whole_file(output) as draft, zipfile.ZipFile(draft, "w") as archive:
        for path in sorted(path for path in content.rglob("*") if path.is_file()):
            entry = zipfile.ZipInfo(str(path.relative_to(content)))
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, path.read_bytes())


def _described(
    texts: Mapping[str, str], files: Sequence[str], products: Sequence[str]
) -> "ROCrate":
    """Return a crate of `texts`, by their names in it, and of `files` in the present folder.

    `products` are those files that the run made.
    """
    from rocrate.rocrate import ROCrate

    crate, version = ROCrate(version="1.1"), commit()
    seconds = os.environ.get("SOURCE_DATE_EPOCH") or max(map(os.path.getmtime, products))
    date = datetime.fromtimestamp(int(seconds), UTC).date().isoformat()  # of the last product
    crate.metadata.extra_terms["sha256"] = "https://w3id.org/ro/terms/workflow-run#sha256"
    for name in sorted((*texts, *files)):
        about = _about(name, texts[name].encode() if name in texts else Path(name).read_bytes())
        if name == WORKFLOW:
            made_by = f"{__version__}, commit {version}" if version else __version__
            about |= {"name": "roughgas", "version": made_by}
            crate.add_workflow(name, name, main=True, lang="snakemake", properties=about)
        else:
            source = io.StringIO(texts[name]) if name in texts else name
            crate.add_file(source, name, properties=about)
    _describe_project(crate, date)
    _describe_run(crate, products, date)
    return crate


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _about(name: str, content: bytes) -> dict[str, Any]:
    kind = "application/x-netcdf" if name.endswith(".nc") else mimetypes.guess_type(name)[0]
    found = {
        "name": name,
        "contentSize": str(len(content)),
        "encodingFormat": kind or "text/plain",
        "sha256": _sha256(content),
    }
    return found | ({"description": MEANINGS[name]} if name in MEANINGS else {})


def _describe_project(crate: "ROCrate", date: str) -> None:
    """Add title, authors, licence and the paper, as CITATION.cff has them."""
    root, cited = crate.root_dataset, read_yaml("CITATION.cff")
    for profile, name in PROFILES.items():
        _add(crate, profile, "CreativeWork", name, version=profile.rsplit("/", 1)[1])
    root["conformsTo"] = [{"@id": profile} for profile in PROFILES]
    root["name"] = f"A run of {cited['title']}"
    root["description"] = (
        "A finished run of the pipeline: its configuration, code, environment, results, figures "
        "and checksums. With Python and make, `make figures` in this folder runs it again."
    )
    root["datePublished"] = date
    authors = enumerate(cited["authors"], 1)
    root["author"] = [_add(crate, f"#author-{number}", *_person(one)) for number, one in authors]
    license = cited["license"]
    root["license"] = _add(crate, f"https://spdx.org/licenses/{license}", "CreativeWork", license)
    root["citation"] = [
        _add(
            crate,
            f"https://doi.org/{work['doi']}",
            "ScholarlyArticle",
            work["title"],
            author=[_person(author)[1] for author in work["authors"]],
            datePublished=str(work["year"]),
            isPartOf=f"{work['journal']} {work['volume']}, {work['start']}",
        )
        for work in cited["references"]
    ]


def _person(author: Mapping[str, str]) -> tuple[str, str]:
    """Return the type and the name of an author."""
    if "name" in author:
        return "Organization", author["name"]
    return "Person", f"{author['given-names']} {author['family-names']}"


def _describe_run(crate: "ROCrate", products: Sequence[str], date: str) -> None:
    """Add the action that made the products from the configuration."""
    who = agent()
    whose = {} if who is None else {"agent": _add(crate, "#agent", "Person", who)}
    crate.root_dataset["mentions"] = crate.add_action(
        instrument=crate.mainEntity,
        identifier="#run",
        object=[crate.dereference(name) for name in (CONFIGURATION, "config.yaml")],
        result=[crate.dereference(name) for name in products],
        properties={
            "name": "The run",
            "endTime": date,
            **whose,
            "description": "in the environment of environment.json; points as listed in points.csv",
        },
    )


def _add(crate: "ROCrate", identifier: str, kind: str, name: str, **properties: Any) -> Any:
    return crate.add_jsonld({"@id": identifier, "@type": kind, "name": name} | properties)
