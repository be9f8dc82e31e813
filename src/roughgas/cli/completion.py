"""`roughgas completion` prints what makes a shell complete this command; what it completes."""

import argparse
from typing import Any

from roughgas.cli.parser import examples

SHELLS = ("bash", "zsh", "fish")
EXAMPLES = examples(
    'eval "$(roughgas completion bash)"      # in ~/.bashrc',
    'eval "$(roughgas completion zsh)"       # in ~/.zshrc, after compinit',
    "roughgas completion fish | source       # in ~/.config/fish/config.fish",
)


def add_commands(commands: Any) -> None:
    """Add the subcommand to argparse's `commands`."""
    parser = commands.add_parser(
        "completion",
        help="complete commands, options and experiments in your shell",
        description="Print the lines that make a shell complete this command when Tab is pressed: "
        "commands, options, files, and the experiments and scales of the configuration in the "
        "present folder.",
        epilog=EXAMPLES,
    )
    parser.add_argument("shell", choices=SHELLS, help="bash, zsh or fish")
    parser.set_defaults(command=completion)


def completion(options: argparse.Namespace) -> None:
    """Print a shell's lines."""
    import argcomplete

    print(argcomplete.shellcode(["roughgas"], shell=options.shell))


def experiments(prefix: str, parsed_args: argparse.Namespace, **_: Any) -> list[str]:
    """Names of experiments; once there is a `/` those of its variants."""
    config = _configuration(parsed_args)
    base, slash, _ = prefix.partition("/")
    if not slash:
        return list(config["experiments"])
    from roughgas.config import experiment, variants

    scale = parsed_args.scale if parsed_args.scale in config["scales"] else config["scale"]
    return variants(base, experiment(config, base, scale))


def scales(parsed_args: argparse.Namespace, **_: Any) -> list[str]:
    """Names of scales."""
    return list(_configuration(parsed_args)["scales"])


def _configuration(options: argparse.Namespace) -> Any:
    """The configuration as it is, unchecked; errors make argcomplete offer nothing."""
    from roughgas.config.reading import read_yaml

    return read_yaml(options.config)
