"""What an RO-Crate of a run says of its files, in the terms of the Workflow Run profile 0.5."""

import hashlib
import mimetypes
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

from roughgas.base.version import __version__
from roughgas.config.reading import read_yaml

if TYPE_CHECKING:
    from rocrate.rocrate import ROCrate

RUN_TERMS = "https://w3id.org/ro/terms/workflow-run#"
PROFILES = {
    "https://w3id.org/ro/wfrun/process/0.5": "Process Run Crate",
    "https://w3id.org/ro/wfrun/workflow/0.5": "Workflow Run Crate",
    "https://w3id.org/workflowhub/workflow-ro-crate/1.0": "Workflow RO-Crate",
}
WORKFLOW = "Snakefile"
MEANINGS = {
    "configuration.json": "the configuration that the run had, with what its command line changed",
    "environment.json": "Python, the machine, and the version of every package installed",
    "points.csv": "each point simulated: a digest of its numbers, the command that makes it again",
    "config.yaml": "every experiment as data",
    "requirements.lock": "the pinned environment",
    "Snakefile": "the workflow",
}
NETCDF = "application/x-netcdf"


def write(content: Path, products: Sequence[str], date: str, commit: str | None) -> None:
    """Describe the files below the folder `content` in its ro-crate-metadata.json.

    `products` are those that the run made, `date` the day on which it ended, `commit` the version
    of its code where it is known.
    """
    from rocrate.rocrate import ROCrate

    crate = ROCrate(version="1.1")
    crate.metadata.extra_terms["sha256"] = f"{RUN_TERMS}sha256"
    files = sorted(path for path in content.rglob("*") if path.is_file())
    for path in files:
        name = str(path.relative_to(content))
        if name == WORKFLOW:
            about = _about(path, name) | {"name": "roughgas", "version": _version(commit)}
            crate.add_workflow(path, name, main=True, lang="snakemake", properties=about)
        else:
            crate.add_file(path, name, properties=_about(path, name))
    _describe(crate, read_yaml(content / "CITATION.cff"), date)
    _tell_the_run(crate, products, date)
    crate.metadata.write(content)


def checksums(content: Path) -> dict[str, str]:
    """The sha256 of each file of the crate in the folder `content`, by name. Raises ValueError or
    KeyError where it is no crate, OSError where it cannot be read."""
    from rocrate.rocrate import ROCrate

    files = ROCrate(content).get_by_type("File")
    return {unquote(file.id): file["sha256"] for file in files}


def sha256(path: Path) -> str:
    """The checksum of a file."""
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _about(path: Path, name: str) -> dict[str, Any]:
    kind = NETCDF if path.suffix == ".nc" else mimetypes.guess_type(name)[0] or "text/plain"
    found = {
        "name": name,
        "contentSize": str(path.stat().st_size),
        "encodingFormat": kind,
        "sha256": sha256(path),
    }
    return found | ({"description": MEANINGS[name]} if name in MEANINGS else {})


def _describe(crate: "ROCrate", cited: dict[str, Any], date: str) -> None:
    """Title, authors, licence and the paper, as CITATION.cff has them."""
    root = crate.root_dataset
    for profile, name in PROFILES.items():
        about = {"@type": "CreativeWork", "name": name, "version": profile.rsplit("/", 1)[1]}
        _add(crate, profile, about)
    root["conformsTo"] = [{"@id": profile} for profile in PROFILES]
    root["name"] = f"A run of {cited['title']}"
    root["description"] = (
        "A finished run of the pipeline: its configuration, code, environment, results, figures "
        "and checksums. With Python and make, `make figures` in this folder runs it again."
    )
    root["datePublished"] = date
    root["author"] = [
        _add(crate, f"#author-{number}", _person(author))
        for number, author in enumerate(cited["authors"], 1)
    ]
    license = f"https://spdx.org/licenses/{cited['license']}"
    root["license"] = _add(crate, license, {"@type": "CreativeWork", "name": cited["license"]})
    root["citation"] = [_paper(crate, work) for work in cited["references"]]


def _person(author: dict[str, str]) -> dict[str, str]:
    if "name" in author:
        return {"@type": "Organization", "name": author["name"]}
    return {"@type": "Person", "name": f"{author['given-names']} {author['family-names']}"}


def _paper(crate: "ROCrate", work: dict[str, Any]) -> Any:
    about = {
        "@type": "ScholarlyArticle",
        "name": work["title"],
        "author": [_person(author)["name"] for author in work["authors"]],
        "datePublished": str(work["year"]),
        "isPartOf": f"{work['journal']} {work['volume']}, {work['start']}",
    }
    return _add(crate, f"https://doi.org/{work['doi']}", about)


def _version(commit: str | None) -> str:
    return __version__ if commit is None else f"{__version__}, commit {commit}"


def _tell_the_run(crate: "ROCrate", products: Sequence[str], date: str) -> None:
    """The action that made the products from the configuration."""
    action = crate.add_action(
        instrument=crate.mainEntity,
        identifier="#run",
        object=[crate.dereference(name) for name in ("configuration.json", "config.yaml")],
        result=[crate.dereference(name) for name in products],
        properties={
            "name": "The run",
            "endTime": date,
            "agent": [{"@id": author.id} for author in crate.root_dataset["author"]],
            "description": "in the environment of environment.json; points as listed in points.csv",
        },
    )
    crate.root_dataset["mentions"] = action


def _add(crate: "ROCrate", identifier: str, properties: dict[str, Any]) -> Any:
    from rocrate.model.contextentity import ContextEntity

    return crate.add(ContextEntity(crate, identifier, properties=properties))
