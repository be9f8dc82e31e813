"""The configuration of one scale, complete in itself."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from roughgas import config as settings
from roughgas.base.files import write_text

HEAD = """\
# The complete configuration of the scale `{scale}`: what experiments inherit from each other, and
# what the scale and the command line change, is written out. Used in place of config.yaml, it gives
# the same results.
"""


def write_effective(config: Mapping[str, Any], scale: str, output: str | Path) -> None:
    """Write a configuration whose only scale is `scale`, which changes nothing, as YAML.

    Raises InputError for an unknown scale.
    """
    import yaml

    names = config["experiments"]
    effective = {
        "scale": scale,
        "seeds_per_job": config.get("seeds_per_job", settings.SEEDS_PER_JOB),
        "experiments": {name: settings.experiment(config, name, scale) for name in names},
        settings.SHOWCASE: settings.showcase(config, scale),
        settings.STUDIES: settings.studies(config, scale),
        "scales": {scale: {}},
    }
    plain = json.loads(json.dumps(effective))  # without anchors
    text = yaml.safe_dump(plain, sort_keys=False, width=100, default_flow_style=None)
    write_text(output, HEAD.format(scale=scale) + text)
