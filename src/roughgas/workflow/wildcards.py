"""Adapters between rules of Snakemake, which pass wildcards, and functions of their values.

Each adapter calls `function` with the values of the wildcards that are its parameters, by name, and
with `fixed` values, which take precedence. It returns a function of Snakemake's arguments. Bad
input ends the workflow with one line.
"""

import inspect
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from roughgas.base import InputError, NamedValues

ForRule = Callable[..., Any]


@contextmanager
def exit_on_bad_input(path: str = "") -> Iterator[None]:
    """End the workflow with one line, which begins with `path`, on an InputError or OSError."""
    try:
        with located(path):
            yield
    except InputError as error:
        sys.exit(f"roughgas: error: {error}")
    except OSError as error:
        sys.exit(f"roughgas: error: {error.filename}: {error.strerror}")


@contextmanager
def located(path: str) -> Iterator[None]:
    """Prefix the key of an InputError with `path`, the path of the requested file.

    An error is prefixed once only.
    """
    try:
        yield
    except InputError as error:
        if path and not getattr(error, "__notes__", ()):
            error.key = f"{path}: {error.key}"
            error.add_note(f"met where {path} was to be made")
        raise


def from_wildcards(function: ForRule, **fixed: Any) -> ForRule:
    """Return an input function, or a param that Snakemake records to rerun a job on changes.

    It takes the wildcards.
    """
    value = _with_values(function, fixed)
    return lambda wildcards: value(wildcards)


def unrecorded(function: ForRule, **fixed: Any) -> ForRule:
    """Return a param that Snakemake does not record, because it takes the output as an argument.

    It is for values that do not affect a file, such as the folder of a study.
    """
    value = _with_values(function, fixed)
    return lambda wildcards, output: value(wildcards)


def per_attempt(function: ForRule, **fixed: Any) -> ForRule:
    """Return a resource of a job; `function` also takes the `attempt`, 1 for the first."""
    value = _with_values(function, fixed)
    return lambda wildcards, attempt: value(wildcards, attempt=attempt)


def _with_values(function: ForRule, fixed: NamedValues) -> ForRule:
    """Return a function of wildcards that calls `function` with them and with `fixed`.

    Only wildcards that are its parameters are passed.
    """
    parameters = inspect.signature(function).parameters

    def value(wildcards: Any, **attempt_values: Any) -> Any:
        """Call `function` with the wildcards that it takes; further keywords take precedence."""
        by_name = {name: label for name, label in wildcards.items() if name in parameters}
        with exit_on_bad_input():
            return function(**{**by_name, **fixed, **attempt_values})

    return value
