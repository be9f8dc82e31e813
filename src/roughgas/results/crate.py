"""A run of the workflow as one file, an RO-Crate, with its code and results; and codemeta.json."""

import hashlib
import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from roughgas.base import InputError, NamedValues, Record, __version__, as_json, from_json
from roughgas.base.files import atomic_write, write_text
from roughgas.base.reading import read_yaml

PROJECT_FILES = (
    *("CHANGELOG.md", "CITATION.cff", "LICENSE", "Makefile", "README.md", "Snakefile"),
    *("config.yaml", "pyproject.toml", "requirements.lock"),
)
PROJECT_FOLDERS = ("article", "profiles", "rules", "src")
CONFIGURATION_FILE = "configuration.json"
CHECKSUM_FILE = "SHA256SUMS"
"""Checksums for `sha256sum --check` in an unpacked crate."""


def project_files(root: str | Path = ".") -> list[str]:
    """Return the paths, relative to `root`, of the project's files that a crate packs."""
    paths = list(PROJECT_FILES)
    for files in (sorted(Path(root, folder).rglob("*.*")) for folder in PROJECT_FOLDERS):
        paths += [str(path.relative_to(root)) for path in files if path.suffix != ".pyc"]
    return paths


def write_crate(products: Sequence[str | Path], output: str | Path, configuration: str) -> None:
    """Write a .zip of the project in the present folder and its `products`, as an RO-Crate.

    Products are paths relative to the folder. The `configuration` is JSON. Raises InputError for
    other text, and for a product or a project outside the folder; OSError for files that cannot be
    read or written.
    """
    from rocrate.rocrate import ROCrate

    parsed = from_json(configuration, "--configuration")
    product_names = [str(product) for product in products]
    if missing := [name for name in PROJECT_FILES if not Path(name).is_file()]:
        legal = f"be one with the workflow, such as a clone of it: {missing[0]} is missing"
        raise InputError("folder", Path.cwd(), legal)
    for name in product_names:
        if Path(name).is_absolute() or ".." in Path(name).parts:
            raise InputError("product", name, "be in this folder")
        Path(name).open("rb").close()
    crate, properties = ROCrate(version="1.1"), {"version": __version__, "name": "roughgas"}
    crate.add_workflow("Snakefile", "Snakefile", main=True, lang="snakemake", properties=properties)
    names = list(dict.fromkeys([*project_files(), *product_names]))
    sums = {name: hashlib.sha256(Path(name).read_bytes()).hexdigest() for name in names}
    files = {
        name: crate.add_file(name, name, properties={"sha256": sums[name]})
        for name in names
        if name != "Snakefile"
    }
    listed = "".join(f"{digest}  {name}\n" for name, digest in sums.items())
    crate.add_file(io.StringIO(listed), CHECKSUM_FILE)
    settings_file = io.StringIO(json.dumps(parsed, indent=1, sort_keys=True) + "\n")
    run_configuration = crate.add_file(settings_file, CONFIGURATION_FILE)
    _describe(crate, run_configuration, [files[name] for name in product_names])
    with atomic_write(output) as draft:
        crate.write_zip(draft)


def _describe(crate: Any, configuration: Any, results: Sequence[Any]) -> None:
    """Add title, authors, licence and paper from CITATION.cff, and the run, to a crate.

    The run made the `results` from the `configuration`; these are entries of the crate.
    """
    citation, root = read_yaml("CITATION.cff"), crate.root_dataset
    root["name"] = f"A run of {citation['title']}"
    root["description"] = "Configuration, code, results and figures of a run of the workflow."
    root["license"] = f"https://spdx.org/licenses/{citation['license']}"
    root["author"] = [full_name(author) for author in citation["authors"]]
    root["citation"] = [f"https://doi.org/{work['doi']}" for work in citation["references"]]
    root["mentions"] = crate.add_action(
        crate.mainEntity, "#run", [configuration], results, {"name": "the run"}
    )


def write_codemeta(citation: str | Path, *, output: str | Path) -> None:
    """Write the metadata of a CITATION.cff as CodeMeta 3.0. Raises InputError if it is no YAML."""
    write_text(output, as_json(codemeta(read_yaml(citation))) + "\n")


def codemeta(citation: Record) -> NamedValues:
    """Return the metadata of a CITATION.cff by CodeMeta's names; missing values are left out.

    `citation` is the content of the file.
    """
    facts = {
        "@context": "https://w3id.org/codemeta/3.0",
        "@type": "SoftwareSourceCode",
        "name": citation["title"].partition(":")[0],
        "description": citation["title"],
        "version": citation["version"],
        "license": f"https://spdx.org/licenses/{citation['license']}",
        "author": [person(author) for author in citation["authors"]],
        "programmingLanguage": ["Python", "Snakemake"],
        "referencePublication": [_article(author) for author in citation.get("references", [])],
        "codeRepository": citation.get("repository-code"),
        "identifier": citation.get("doi"),
        "datePublished": citation.get("date-released"),
    }
    return {name: author for name, author in facts.items() if author is not None}


def person(author: Mapping[str, str]) -> dict[str, str]:
    """Return an author in CITATION.cff as a Person of schema.org, or else an Organization.

    An author with a single `name` is an Organization.
    """
    if "name" in author:
        return {"@type": "Organization", "name": author["name"]}
    properties = {"@type": "Person", "givenName": author["given-names"]}
    properties["familyName"] = author["family-names"]
    return properties | ({"@id": author["orcid"]} if "orcid" in author else {})


def full_name(author: Mapping[str, str]) -> str:
    """Return the full name of an author in CITATION.cff, given name first."""
    return author.get("name") or f"{author['given-names']} {author['family-names']}"


def _article(work: Record) -> NamedValues:
    """Return a reference in CITATION.cff as a ScholarlyArticle of schema.org."""
    return {
        "@type": "ScholarlyArticle",
        "@id": f"https://doi.org/{work['doi']}",
        "name": work["title"],
        "author": [person(author) for author in work["authors"]],
        "isPartOf": work["journal"],
        "datePublished": str(work["year"]),
    }
