"""What is made of results for people: tables of points and of run times, and a run as one file, an
RO-Crate, with its configuration, code, results and figures. CITATION.cff as codemeta.json.
"""

import csv
import hashlib
import io
import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.base import InputError, __version__, as_json, in_csv, markdown
from roughgas.base.files import whole_file, write_text
from roughgas.config.reading import read_yaml
from roughgas.data.reduced import GRID, particles_of, read_reduced, third_axis
from roughgas.statistics.errors import half_width
from roughgas.theory.prediction import predicted_ratio

if TYPE_CHECKING:
    import xarray

ABOUT = ("experiment", "scale", "particles", "dimension", "inertia", "parameter", "value")
COLUMNS = (
    *("n_seeds", "R", "R_stderr", "R_dof", "R_ci95", "R_ci95_trusted"),
    *("R_stderr_over_seeds", "R_stderr_within", "R_ratio_of_means", "R_corrected"),
    *("R_collisional", "R_collisional_stderr"),
    *("R_unsubtracted", "R_unsubtracted_stderr", "E_trans", "E_trans_stderr", "E_rot"),
    *("input_spin_share", "equilibrated", "measured_from", "measured_for"),
    *("collisions", "contact_time_fraction"),
)
THEORY = ("theory", "R_theory", "residual")
FEW = 5.0
"""Degrees of freedom of an error, below which its interval is noticeably wider."""
HEAD = (*ABOUT, *GRID, *COLUMNS, *THEORY)
RUN_TIMES = """\
# Run times

What the simulations of each experiment took, all points and seeds together: CPU seconds in the
kernel, without starting processes and compiling.

"""
TIMES = "experiment | particles | points | seeds | collisions | CPU seconds | collisions a second"


def write_table(inputs: Iterable[str | Path], *, output: str | Path) -> None:
    """Write one tidy CSV, a row for each point of each experiment."""
    with whole_file(output) as draft, open(draft, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(HEAD)
        for path in inputs:
            for row in rows(read_reduced(path)):
                table.writerow(map(_in_csv, row.values()))


def rows(dataset: "xarray.Dataset", head: Sequence[str] = HEAD) -> Iterator[dict[str, Any]]:
    """Yield the rows of a reduced dataset, ascending in the third axis, r and beta.

    Each has the names in `head`, which may be those of HEAD, of variables over the grid, or of
    attributes; the value is "" where the dataset has no such thing, NaN for an unknown number.
    """
    swept, variants = third_axis(dataset.attrs), [dataset]
    if swept is not None:
        values = enumerate(dataset[swept].values)
        about = {index: {swept: x, "parameter": swept, "value": x} for index, x in values}
        variants = [
            dataset.isel({swept: index}, drop=True).assign_attrs(own)
            for index, own in about.items()
        ]
    for one in variants:
        flat = one.drop_dims("seed").stack(point=GRID)
        prediction = predicted_ratio(one.attrs, flat.r.values, flat.beta.values)
        for index in np.flatnonzero(flat["n_seeds"].values):
            row = {name: flat[name].values[index] for name in head if name in flat}
            residual = row.get("R", math.nan) - prediction[index]
            row |= {"R_theory": prediction[index], "residual": residual}
            yield {name: row.get(name, one.attrs.get(name, "")) for name in head}


def why_wide(dataset: "xarray.Dataset") -> str:
    """Return a sentence on intervals that are wide since few seeds say little of their errors;
    nothing if there are none."""
    freedom = np.atleast_1d(dataset["R_dof"] if "R_dof" in dataset else math.inf).ravel()
    few = freedom[np.isfinite(freedom) & (freedom < FEW)]  # where there is no point, NaN
    if not few.size:
        return ""
    points, seeds = int((dataset.n_seeds > 0).sum()), int(dataset.n_seeds.max())
    fewest, many = max(1.0, float(few.min())), f"{seeds} seed{'s' * (seeds > 1)}"
    wide = half_width(1.0, fewest, 0.95)
    return (
        f"\nWide intervals: {few.size} of {points}, since errors from {many} are uncertain: "
        f"known with {fewest:.2g}\ndegrees of freedom, 95 % are {wide:.1f} standard errors to each "
        "side, not 2.0. More seeds narrow them."
    )


def _in_csv(value: Any) -> str:
    """Return a number with ten digits; an empty cell for NaN."""
    if isinstance(value, str):
        return in_csv(value)
    return "" if math.isnan(value) else format(value, ".10g")


def write_times(inputs: Iterable[str | Path], *, output: str | Path) -> None:
    """Write a Markdown table with a row for each reduced dataset, and one for their sum."""
    rows, spent = [], []
    for data in map(read_reduced, inputs):
        seeds, collisions, seconds = data.n_seeds, data.collisions.sum(), data.kernel_seconds.sum()
        spent.append((int((seeds > 0).sum()), int(seeds.sum()), int(collisions), float(seconds)))
        rows.append([data.attrs["experiment"], particles_of(data), *_sums(*spent[-1])])
    rows.append(["together", "", *_sums(*map(sum, zip(*spent, strict=True)))])
    write_text(output, RUN_TIMES + markdown(TIMES.split(" | "), rows))


def _sums(points: int, seeds: int, collisions: int, seconds: float) -> list[str]:
    counts = [f"{count:,}" for count in (points, seeds, collisions)]
    return [*counts, f"{seconds:,.1f}", f"{collisions / seconds:,.0f}" if seconds > 0 else ""]


PROJECT = (
    *("CHANGELOG.md", "CITATION.cff", "LICENSE", "Makefile", "README.md", "Snakefile"),
    *("config.yaml", "pyproject.toml", "requirements.lock"),
)
FOLDERS = ("article", "profiles", "rules", "src")
CONFIGURATION = "configuration.json"
CHECKSUMS = "SHA256SUMS"
"""What `sha256sum --check` reads, in a crate that has been unpacked."""


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
    names = list(dict.fromkeys([*project_files(), *made]))
    sums = {name: hashlib.sha256(Path(name).read_bytes()).hexdigest() for name in names}
    files = {
        n: crate.add_file(n, n, properties={"sha256": sums[n]}) for n in names if n != "Snakefile"
    }
    listed = "".join(f"{digest}  {name}\n" for name, digest in sums.items())
    crate.add_file(io.StringIO(listed), CHECKSUMS)
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
    root["author"] = [called(one) for one in cited["authors"]]
    root["citation"] = [f"https://doi.org/{work['doi']}" for work in cited["references"]]
    root["mentions"] = crate.add_action(
        crate.mainEntity, "#run", [configuration], results, {"name": "the run"}
    )


def write_codemeta(citation: str | Path, *, output: str | Path) -> None:
    """Write the facts of a CITATION.cff by CodeMeta 3.0. Raises InputError if it is no YAML."""
    write_text(output, as_json(codemeta(read_yaml(citation))) + "\n")


def codemeta(cited: Mapping[str, Any]) -> dict[str, Any]:
    """Return the facts of a CITATION.cff by the names of CodeMeta; what it lacks is left out."""
    found = {
        "@context": "https://w3id.org/codemeta/3.0",
        "@type": "SoftwareSourceCode",
        "name": cited["title"].partition(":")[0],
        "description": cited["title"],
        "version": cited["version"],
        "license": f"https://spdx.org/licenses/{cited['license']}",
        "author": [person(one) for one in cited["authors"]],
        "programmingLanguage": ["Python", "Snakemake"],
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
