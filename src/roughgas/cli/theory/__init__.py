"""`roughgas theory`: what theory says of R, at a point or along a curve."""

import argparse
from typing import Any

from roughgas.cli.parser import examples

EXAMPLES = examples(
    "roughgas theory --r 0.9 --beta 0.5",
    "roughgas theory --r 0.9 --beta -1:1:0.1 --dimension 2",
    "roughgas theory --r 0.8 0.9 0.99 --beta 0 --inertia 0.1 --json",
    "roughgas theory --r 0.9 --beta 0.5 --mu 0.3",
    "roughgas theory --r 0.9 --beta -0.9:0.9:0.1 --spin-share 0.2 --csv",
)


def add_commands(commands: Any) -> None:
    """Add the subcommand to argparse's `commands`."""
    parser = commands.add_parser(
        "theory",
        help="what theory says of R, at a point or along a curve",
        description="Print R = E_rot/(E_rot + E_trans) of theory, driven and freely cooling, how "
        "fast it is reached, and how fast energy decays; with the equation that each number is "
        "from. r and beta take several values, or a range START:STOP:STEP with both ends.",
        epilog=EXAMPLES,
    )
    values = {"required": True, "nargs": "+", "metavar": "VALUE"}
    parser.add_argument("--r", **values, help="normal restitution, in [0, 1]: 1 is elastic")
    parser.add_argument("--beta", **values, help="roughness, in [-1, 1]: 1 is perfectly rough")
    parser.add_argument("--dimension", choices=("2", "3"), help="default: both")
    parser.add_argument(
        "--inertia",
        metavar="Q",
        help="moment of inertia in m a^2 (default: that of uniform disks, 0.5, or spheres, 0.4)",
    )
    parser.add_argument(
        "--spin-share", default="0", metavar="S", help="of the drive's power (default: 0)"
    )
    parser.add_argument("--mu", help="Coulomb friction (default: none, contacts never slide)")
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="for scripts")
    form.add_argument("--csv", action="store_true", help="for spreadsheets")
    parser.set_defaults(command=theory)


def theory(options: argparse.Namespace) -> None:
    """Print theory's numbers."""
    from roughgas.cli.theory import output
    from roughgas.cli.theory.quantities import quantities
    from roughgas.cli.theory.request import gases

    tables = [(gas, quantities(gas)) for gas in gases(options)]
    if options.json:
        print(output.as_record(tables))
    elif options.csv:
        output.write_csv(tables)
    elif len(tables[0][0].r) == 1:
        print(output.point(tables))
    else:
        print(output.curve(tables))
