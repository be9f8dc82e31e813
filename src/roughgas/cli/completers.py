"""Completions that a shell offers for the values of options.

argcomplete calls these functions with the word typed until now (`prefix`) and with the options that
precede it (`parsed_args`). After an error it offers nothing.
"""

from argparse import Namespace
from contextlib import suppress
from pathlib import Path
from typing import Any


def experiments(prefix: str, parsed_args: Namespace, **unused: Any) -> list[str]:
    """Return the names of all experiments; after `EXPERIMENT/`, of the variants of this experiment.

    The configuration is not checked, as that would be too slow for a completion.
    """
    from roughgas.config import active_config_path, default_scale, load_experiment
    from roughgas.config.study_folders import folders

    path = parsed_args.config or active_config_path()
    base, slash, _ = prefix.partition("/")
    if slash:
        scale = parsed_args.scale or default_scale(path)
        return load_experiment(path, base, scale).variants(base)
    names = _section_keys(path, "experiments")
    for name, folder in folders(path).items():
        with suppress(Exception):  # a broken study offers no names
            names += [
                f"{name}.{key}" for key in _section_keys(folder / "config.yaml", "experiments")
            ]
    return names


def scales(parsed_args: Namespace, **_: Any) -> list[str]:
    """Return the names of all scales of the configuration, such as paper and small."""
    from roughgas.config import active_config_path

    return _section_keys(parsed_args.config or active_config_path(), "scales")


def _section_keys(path: str | Path, section: str) -> list[str]:
    """Return the keys in the top-level section `section` of the configuration at `path`, which is
    not checked."""
    import yaml

    from roughgas.base.files import content_of

    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    return [*yaml.load(content_of(path, str(path)), loader)[section]]
