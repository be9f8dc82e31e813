"""`roughgas completion` prints what makes a shell complete this command; what it completes."""

from argparse import Namespace
from typing import Any

SHELLS = ("bash", "zsh", "fish")


def completion(options: Namespace) -> None:
    """Print a shell's lines."""
    import argcomplete

    print(argcomplete.shellcode(["roughgas"], shell=options.shell))


def experiments(prefix: str, parsed_args: Namespace, **_: Any) -> list[str]:
    """Return the names of experiments; after a `/`, those of an experiment's variants."""
    config = _configuration(parsed_args)
    base, slash, _ = prefix.partition("/")
    if not slash:
        return list(config["experiments"])
    from roughgas.config import experiment, variants

    scale = parsed_args.scale if parsed_args.scale in config["scales"] else config["scale"]
    return variants(base, experiment(config, base, scale))


def scales(parsed_args: Namespace, **_: Any) -> list[str]:
    """Return the names of scales."""
    return list(_configuration(parsed_args)["scales"])


def _configuration(options: Namespace) -> Any:
    """Return the configuration unchecked; errors make argcomplete offer nothing."""
    from roughgas.config.reading import read_yaml

    return read_yaml(options.config)
