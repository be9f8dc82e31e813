"""Types of mappings of names to values, and their merging."""

from collections.abc import Mapping
from typing import Any

Attributes = Mapping[str, Any]
"""Attributes of a dataset, or of a variable, by name."""
Record = Mapping[str, Any]
"""Values by name as read from JSON, a table row or a page."""
NamedValues = dict[str, Any]
"""Values by name as computed by a function, such as the variables of a dataset."""


def merged(
    base: Mapping[str, Any], changes: Mapping[str, Any], removing: bool = True
) -> dict[str, Any]:
    """Return a copy of `base` with `changes` merged in, nested mappings key by key.

    A change to None removes its key; without `removing`, None is kept, for merging changes.
    """
    result = dict(base)
    for key, change in changes.items():
        if change is None and removing:
            result.pop(key, None)
        elif isinstance(change, Mapping):
            inner = result.get(key)
            result[key] = merged(inner if isinstance(inner, Mapping) else {}, change, removing)
        else:
            result[key] = change
    return result


def shared_entries(first: Record, second: Record) -> NamedValues:
    """Return the entries that two records share, nested mappings key by key."""
    shared = {}
    for key in first.keys() & second.keys():
        value, other = first[key], second[key]
        if isinstance(value, Mapping) and isinstance(other, Mapping):
            shared[key] = shared_entries(value, other)
        elif value == other:
            shared[key] = value
    return shared
