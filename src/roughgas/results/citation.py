"""CITATION.cff, for those who read its facts in another form: codemeta.json."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from roughgas.base import as_json
from roughgas.base.files import write_text
from roughgas.config.reading import read_yaml

CONTEXT = "https://w3id.org/codemeta/3.0"
LANGUAGES = ("Python", "Snakemake")


def write_codemeta(citation: str | Path, *, output: str | Path) -> None:
    """Write the facts of a CITATION.cff by CodeMeta 3.0. Raises InputError if it is no YAML."""
    write_text(output, as_json(codemeta(read_yaml(citation))) + "\n")


def codemeta(cited: Mapping[str, Any]) -> dict[str, Any]:
    """Return the facts of a CITATION.cff by the names of CodeMeta; what it lacks is left out."""
    found = {
        "@context": CONTEXT,
        "@type": "SoftwareSourceCode",
        "name": cited["title"].partition(":")[0],
        "description": cited["title"],
        "version": cited["version"],
        "license": f"https://spdx.org/licenses/{cited['license']}",
        "author": [person(one) for one in cited["authors"]],
        "programmingLanguage": list(LANGUAGES),
        "referencePublication": [_article(one) for one in cited.get("references", [])],
        "codeRepository": cited.get("repository-code"),
        "identifier": cited.get("doi"),
        "datePublished": cited.get("date-released"),
    }
    return {name: one for name, one in found.items() if one is not None}


def person(author: Mapping[str, str]) -> dict[str, str]:
    """Return an author as schema.org has it: a person, or a group that has only a name."""
    if "name" in author:
        return {"@type": "Organization", "name": author["name"]}
    found = {"@type": "Person", "givenName": author["given-names"]}
    found["familyName"] = author["family-names"]
    return found | ({"@id": author["orcid"]} if "orcid" in author else {})


def called(author: Mapping[str, str]) -> str:
    """Return the name of an author in one piece."""
    return author.get("name") or f"{author['given-names']} {author['family-names']}"


def _article(work: Mapping[str, Any]) -> dict[str, Any]:
    return {
        "@type": "ScholarlyArticle",
        "@id": f"https://doi.org/{work['doi']}",
        "name": work["title"],
        "author": [person(one) for one in work["authors"]],
        "isPartOf": work["journal"],
        "datePublished": str(work["year"]),
    }
