"""A finished run as one file, an RO-Crate: configuration, code, results, figures."""

import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from roughgas.base import InputError, __version__
from roughgas.base.files import whole_file
from roughgas.config.reading import read_yaml

PROJECT = (
    *("CHANGELOG.md", "CITATION.cff", "LICENSE", "Makefile", "README.md", "Snakefile"),
    *("config.yaml", "pyproject.toml", "requirements.lock"),
)
FOLDERS = ("profiles", "rules", "src")
CONFIGURATION = "configuration.json"


def project_files(root: str | Path = ".") -> list[str]:
    """Return the files in `root` that a run of the workflow consists of, relative to it."""
    found = list(PROJECT)
    for files in (sorted(Path(root, folder).rglob("*.*")) for folder in FOLDERS):
        found += [str(path.relative_to(root)) for path in files if path.suffix != ".pyc"]
    return found


def write_crate(
    products: Sequence[str | Path], output: str | Path, configuration: Mapping[str, Any]
) -> None:
    """Write a .zip of the project in this folder and its `products`, paths relative to it.

    Raises InputError if a product, or the project, is elsewhere; OSError as files do.
    """
    from rocrate.rocrate import ROCrate

    made = [str(product) for product in products]
    if missing := [name for name in PROJECT if not Path(name).is_file()]:
        legal = f"be one with the workflow, such as a clone of it: {missing[0]} is missing"
        raise InputError("folder", Path.cwd(), legal)
    for name in made:
        if Path(name).is_absolute() or ".." in Path(name).parts:
            raise InputError("product", name, "be in this folder")
        Path(name).open("rb").close()
    crate, about = ROCrate(version="1.1"), {"version": __version__, "name": "roughgas"}
    crate.add_workflow("Snakefile", "Snakefile", main=True, lang="snakemake", properties=about)
    files = {n: crate.add_file(n, n) for n in [*project_files(), *made] if n != "Snakefile"}
    settings = io.StringIO(json.dumps(configuration, indent=1, sort_keys=True) + "\n")
    _describe(crate, crate.add_file(settings, CONFIGURATION), [files[name] for name in made])
    with whole_file(output) as draft:
        crate.write_zip(draft)


def _describe(crate: Any, configuration: Any, results: Sequence[Any]) -> None:
    """Add title, authors, licence and paper, as CITATION.cff has them, and the run."""
    cited, root = read_yaml("CITATION.cff"), crate.root_dataset
    root["name"] = f"A run of {cited['title']}"
    root["description"] = "Configuration, code, results and figures of a run of the workflow."
    root["license"] = f"https://spdx.org/licenses/{cited['license']}"
    root["author"] = [_name(one) for one in cited["authors"]]
    root["citation"] = [f"https://doi.org/{work['doi']}" for work in cited["references"]]
    root["mentions"] = crate.add_action(
        crate.mainEntity, "#run", [configuration], results, {"name": "the run"}
    )


def _name(author: Mapping[str, str]) -> str:
    return author.get("name") or f"{author['given-names']} {author['family-names']}"
