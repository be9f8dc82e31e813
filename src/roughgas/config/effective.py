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
        "complete": True,
        "scale": scale,
        "seeds_per_job": config.get("seeds_per_job", settings.SEEDS_PER_JOB),
        "betas_per_job": config.get("betas_per_job", 1),
        "experiments": {name: settings.experiment(config, name, scale) for name in names},
    }
    parts = {settings.SHOWCASE: settings.showcase, settings.STUDIES: settings.studies}
    effective |= {part: of(config, scale) for part, of in parts.items() if part in config}
    effective["scales"] = {scale: {}}
    plain = json.loads(json.dumps(effective))  # without anchors
    text = yaml.safe_dump(plain, sort_keys=False, width=100, default_flow_style=None)
    write_text(output, HEAD.format(scale=scale) + text)
