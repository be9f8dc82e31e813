"""Where results come from: attributes of a dataset, enough to make it again by itself, and the
complete configuration of a scale."""

import json
import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from roughgas import config
from roughgas.base import InputError
from roughgas.base.files import write_text

HEAD = """\
# The complete configuration of the scale `{scale}`: what experiments inherit from each other, and
# what the scale and the command line change, is written out. Used in place of config.yaml, it gives
# the same results.
"""


def provenance(
    experiment: str,
    settings: Mapping[str, Any],
    point: tuple[str, str, str],
    scale: str,
    output: str,
    verb: str = "run",
    told: Sequence[str] = (),
) -> dict[str, Any]:
    """Return the attributes of a point's dataset that say how to make it again.

    `point` has its labels (r, beta, seed); the command among the attributes, `roughgas VERB`, is
    told what else is in `told`, and writes to `output`.
    Raises InputError where the name of the experiment and the settings disagree.
    """
    text = config.as_text(config.point_settings(settings))
    r, beta, seed = point
    command = ["roughgas", verb, experiment, "--scale", scale]
    # joined by =, so that a negative number is not taken for an option
    command += [f"--r={r}", f"--beta={beta}", f"--seed={seed}"]
    command += [*told, "--settings", text, "--output", output]
    return {
        "title": f"{experiment}: r = {r}, beta = {beta}",
        **variant_attributes(experiment, settings),
        "scale": scale,
        "r_label": r,
        "beta_label": beta,
        "experiment_json": text,
        "command": shlex.join(command),
    }


def variant_attributes(name: str, settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return the attributes of a dataset that name its experiment, and its variant if any.

    Raises InputError where name and settings disagree.
    """
    base, slash, variant = name.partition("/")
    key = settings.get(config.SWEPT)
    if key is None and not slash:
        return {"experiment": base}
    parameter = config.parameter_of(key or "")
    value = config.swept_value(settings, key or "")
    label = variant.removeprefix(parameter)
    if value is None or label == variant or config.level(label) != value:
        raise InputError("experiment", name, "be the variant that its settings are of")
    return {"experiment": base, "variant": variant, "swept": key, "swept_value": value}


def write_effective(whole: Mapping[str, Any], scale: str, output: str | Path) -> None:
    """Write a configuration whose only scale is `scale`, which changes nothing, as YAML.

    Raises InputError for an unknown scale.
    """
    import yaml

    names = whole["experiments"]
    effective = {
        "complete": True,
        "scale": scale,
        "seeds_per_job": whole.get("seeds_per_job", config.SEEDS_PER_JOB),
        "betas_per_job": whole.get("betas_per_job", 1),
        "experiments": {name: config.experiment(whole, name, scale) for name in names},
    }
    if config.ACCURACY in whole:
        effective[config.ACCURACY] = config.accuracy(whole, scale)
    effective["scales"] = {scale: {}}
    plain = json.loads(json.dumps(effective))  # without anchors
    text = yaml.safe_dump(plain, sort_keys=False, width=100, default_flow_style=None)
    write_text(output, HEAD.format(scale=scale) + text)
