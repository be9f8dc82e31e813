"""Whether the findings and criteria of a study belong to its data: by its name and a digest.

README.md of a study states findings, and claims.yaml says which criteria were fixed before the
data. Both are true of one study with its experiments, effects, observables, tasks and criteria.
findings.yaml in its folder therefore holds its name and their digest; for a copied or edited study
they differ. A criterion is fixed by writing this file, with `python -m roughgas.steps
fix_criteria`, before the data are simulated.
"""

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from roughgas.base import InputError, Record, check_one_of, sorted_json
from roughgas.base.files import sources_in, write_text
from roughgas.base.reading import read_yaml
from roughgas.config.configuration import PAPER, Configuration
from roughgas.config.study_code import EFFECTS, OBSERVABLES

FILE = "findings.yaml"
WITHOUT_EFFECT = {"description", "extends", "seeds_per_job", "betas_per_job"}
"""Keys of an experiment that do not affect its data."""
CRITERION_KEYS = {
    *("experiments", "judge", "agrees_with", "sample", "in_proportion"),
    *("variable", "relative", "within", "criterion", "refuted_beyond"),
}
"""Keys of a statement in claims.yaml that say how it is judged."""
HEAD = """\
# The findings in README.md, and the time at which claims.yaml says that criteria were fixed, are of
# this study with these experiments, tasks and criteria: `python -m roughgas.steps fix_criteria`.
"""


def digest(configuration: Configuration, name: str) -> str:
    """Return a hash of the experiments, tasks and criteria of the study `name`, 16 hex digits.

    Settings are complete, at the scale `paper`, and without their names and descriptions; a study
    with effects or observables has the text of their files, too. Raises InputError for a
    configuration without this scale or study, and for illegal settings.
    """
    check_one_of("study", name, configuration.studies)
    check_one_of("scale", PAPER, configuration.scales)
    study = configuration.studies[name]
    statements = _statements(Path(study.folder))
    named = [key for row in statements.values() for key in row["experiments"]]
    experiments = {key.rpartition(".")[2]: key for key in study.experiments}
    experiments |= {key: key for key in named if key in configuration.experiments}
    settings: dict[str, Any] = {
        key: _without(configuration.experiment(full_name, PAPER).raw, WITHOUT_EFFECT)
        for key, full_name in experiments.items()
    }
    criteria = {key: _only(row, CRITERION_KEYS) for key, row in statements.items()}
    tasks = study.tasks.settings[PAPER] if study.tasks else {}
    text = sorted_json({"experiments": settings, "tasks": tasks, "criteria": criteria})
    text += sources_in(study.folder, EFFECTS, OBSERVABLES)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def reservation(configuration: Configuration, name: str) -> str:
    """Return a sentence why findings and criteria are not of the study `name`, or "" if they are.

    Raises InputError for an unknown study, and for an illegal findings.yaml.
    """
    path = Path(configuration.studies[name].folder) / FILE
    if not path.exists():
        return f"No {FILE} says that criteria were fixed before these data."
    belongs = read_yaml(path)
    if belongs["study"] != name:
        return (
            f"Findings and criteria were written for the data of another study, {belongs['study']}."
        )
    try:
        is_same = digest(configuration, name) == belongs["digest"]
    except InputError:  # such as a complete configuration of another scale
        return f"The configuration lacks the scale {PAPER}, which findings and criteria are of."
    return "" if is_same else "Findings were written for data of other experiments or criteria."


def write(configuration: Configuration, name: str) -> str:
    """Write findings.yaml of the study `name`: its criteria are fixed. Return the digest.

    Raises InputError as `digest`.
    """
    hexdigest = digest(configuration, name)
    path = Path(configuration.studies[name].folder) / FILE
    write_text(path, f'{HEAD}study: {name}\ndigest: "{hexdigest}"\n')
    return hexdigest


def _statements(folder: Path) -> Mapping[str, Record]:
    """Return the statements in claims.yaml of a study, which is already checked; {} without it."""
    path = folder / "claims.yaml"
    table = read_yaml(path) if path.exists() else {}
    statements: Mapping[str, Record] = table.get("statements", table)
    return statements


def _without(settings: Any, keys: set[str]) -> Record:
    """Return settings by key without some `keys`."""
    return {key: content for key, content in settings.items() if key not in keys}


def _only(row: Record, keys: set[str]) -> Record:
    """Return the cells of a statement under some `keys` alone."""
    return {key: content for key, content in row.items() if key in keys}
