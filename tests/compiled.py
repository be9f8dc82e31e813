"""Compiled functions that only compiled code may call, made callable from Python."""

from roughgas.compiling.jit import entry


def from_python(function):
    """`function` with an entry from Python."""
    return entry(lambda *arguments: function(*arguments))
