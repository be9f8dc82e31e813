"""`roughgas doctor` says what is wrong with an installation."""

import argparse
from typing import Any

from roughgas.cli.parser import examples

DESCRIPTION = (
    "Check Python, libraries, compiled kernels, folders and the configuration, say what is wrong "
    "with them and what to do about it. Exit status 1 where there is a problem."
)
EXAMPLE = examples("roughgas doctor")


def add_commands(commands: Any) -> None:
    """Add the subcommand to argparse's `commands`."""
    parser = commands.add_parser(
        "doctor",
        help="say what is wrong with the installation",
        description=DESCRIPTION,
        epilog=EXAMPLE,
    )
    parser.add_argument("--json", action="store_true", help="for programs, or to send it on")
    parser.add_argument(
        "--clean", action="store_true", help="remove compiled kernels of other versions, and end"
    )
    parser.set_defaults(command=doctor)


def doctor(options: argparse.Namespace) -> None:
    """Check everything; exits with 1 where there is a problem."""
    if options.clean:
        from roughgas.doctor.machine import clean

        print(clean())
        return
    import json

    from roughgas.doctor import PROBLEM, examine, in_words, summary

    found = {}
    for name, finding in examine():
        found[name] = finding
        if not options.json:
            print(in_words(name, finding), flush=True)
    if options.json:
        print(json.dumps({name: finding._asdict() for name, finding in found.items()}, indent=2))
    else:
        print(f"\n{summary(list(found.values()))}")
    if any(finding.verdict == PROBLEM for finding in found.values()):
        raise SystemExit(1)
