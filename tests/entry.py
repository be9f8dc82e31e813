"""`roughgas` and the steps of its workflow, called as one."""

from roughgas import cli, steps


def main(arguments):
    """The exit status of a step, or of another command."""
    return (steps.main if arguments[0] in steps.STEPS else cli.main)(arguments)
