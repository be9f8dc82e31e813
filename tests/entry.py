"""`roughgas` and the steps of its workflow, called as one."""

import contextlib
import io

from roughgas import cli, steps


def main(arguments):
    """The exit status of a step, or of another command."""
    return (steps.main if arguments[0] in steps.STEPS else cli.main)(arguments)


def outcome(arguments):
    """The exit status of a command line, and its lines of errors."""
    output, errors = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
        try:
            status = main(arguments)
        except SystemExit as end:
            status = end.code
    return status, errors.getvalue()
