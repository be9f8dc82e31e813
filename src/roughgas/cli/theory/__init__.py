"""`roughgas theory`: what theory says of R, at a point or along a curve."""

from argparse import Namespace


def theory(options: Namespace) -> None:
    """Print theory's numbers."""
    from roughgas.cli.theory import output
    from roughgas.cli.theory.quantities import quantities
    from roughgas.cli.theory.request import gases

    tables = [(gas, quantities(gas)) for gas in gases(options)]
    if options.csv:
        output.write_csv(tables)
    elif options.json:
        print(output.as_record(tables))
    else:
        print(output.point(tables) if len(tables[0][0].r) == 1 else output.curve(tables))
