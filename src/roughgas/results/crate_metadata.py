"""What an RO-Crate of a run says of its files, in the terms of the Workflow Run profile 0.5."""

import hashlib
import mimetypes
from collections.abc import Mapping, Sequence
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roughgas.base.version import __version__
from roughgas.config.reading import read_yaml

if TYPE_CHECKING:
    from rocrate.rocrate import ROCrate

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


def described(
    texts: Mapping[str, str],
    files: Sequence[str],
    products: Sequence[str],
    date: str,
    commit: str | None,
) -> "ROCrate":
    """Return a crate of `texts`, by their names in it, and of `files` in the present folder.

    `products` are those files that the run made, `date` is the day on which it ended, and `commit`
    the version of its code where it is known.
    """
    from rocrate.rocrate import ROCrate

    crate = ROCrate(version="1.1")
    crate.metadata.extra_terms["sha256"] = "https://w3id.org/ro/terms/workflow-run#sha256"
    for name in sorted((*texts, *files)):
        content = texts[name].encode() if name in texts else Path(name).read_bytes()
        about = _about(name, content)
        if name == WORKFLOW:
            version = __version__ if commit is None else f"{__version__}, commit {commit}"
            about |= {"name": "roughgas", "version": version}
            crate.add_workflow(name, name, main=True, lang="snakemake", properties=about)
        else:
            source = StringIO(texts[name]) if name in texts else name
            crate.add_file(source, name, properties=about)
    _describe_project(crate, date)
    _describe_run(crate, products, date)
    return crate


def sha256(content: bytes) -> str:
    """Return the checksum of the content of a file."""
    return hashlib.sha256(content).hexdigest()


def _about(name: str, content: bytes) -> dict[str, Any]:
    kind = mimetypes.guess_type(name)[0] or "text/plain"
    found = {
        "name": name,
        "contentSize": str(len(content)),
        "encodingFormat": "application/x-netcdf" if name.endswith(".nc") else kind,
        "sha256": sha256(content),
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
    root["author"] = [
        _add(crate, f"#author-{number}", *_person(author))
        for number, author in enumerate(cited["authors"], 1)
    ]
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
    crate.root_dataset["mentions"] = crate.add_action(
        instrument=crate.mainEntity,
        identifier="#run",
        object=[crate.dereference(name) for name in (CONFIGURATION, "config.yaml")],
        result=[crate.dereference(name) for name in products],
        properties={
            "name": "The run",
            "endTime": date,
            "agent": [{"@id": author.id} for author in crate.root_dataset["author"]],
            "description": "in the environment of environment.json; points as listed in points.csv",
        },
    )


def _add(crate: "ROCrate", identifier: str, kind: str, name: str, **properties: Any) -> Any:
    return crate.add_jsonld({"@id": identifier, "@type": kind, "name": name} | properties)
