"""The configuration of one scale, complete in itself."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from roughgas import config as settings
from roughgas.base.files import write_text

HEAD = """\
# The complete configuration of the scale `{scale}`: what experiments take over from each other, and
# what the scale and the command line change, is written out. In place of config.yaml it gives the
# same results.
"""


def effective(config: Mapping[str, Any], scale: str) -> dict[str, Any]:
    """A configuration whose only scale is `scale`, which changes nothing: all is said above it.

    Raises InputError for an unknown scale.
    """
    names = config["experiments"]
    experiments = {name: settings.experiment(config, name, scale) for name in names}
    changes = config["scales"][scale]
    return {
        "scale": scale,
        "seeds_per_job": config.get("seeds_per_job", settings.SEEDS_PER_JOB),
        "experiments": experiments,
        "showcase": settings.showcase(config, scale),
        "accuracy": settings.merged(config["accuracy"], changes.get("accuracy", {})),
        "scales": {scale: {}},
    }


def write_effective(config: Mapping[str, Any], scale: str, output: str | Path) -> None:
    """Write the configuration of `scale` as YAML that can be loaded again."""
    import yaml

    plain = json.loads(json.dumps(effective(config, scale)))  # without anchors
    text = yaml.safe_dump(plain, sort_keys=False, width=100, default_flow_style=None)
    write_text(output, HEAD.format(scale=scale) + text)
