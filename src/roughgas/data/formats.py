"""Versions of the file formats, which are checked when a file is opened.

A change that breaks readers increments `newest`; if the code cannot read the earlier formats any
longer, it sets `oldest`, too.
"""

from typing import NamedTuple

from roughgas.base import InputError


class Format(NamedTuple):
    """The range of versions of a format that this roughgas reads; it writes the newest."""

    oldest: int
    newest: int
    remedy: str  # for a file of another version

    def check(self, key: str, version: int) -> None:
        """Raise InputError, with this `key`, for a version outside the range."""
        if version > self.newest:
            legal = f"be at most {self.newest}: a newer roughgas has written the file"
        elif version < self.oldest:
            legal = f"be at least {self.oldest}: an older roughgas has written the file"
        else:
            return
        raise InputError(key, version, f"{legal}; {self.remedy}")


DATASET = Format(1, 2, "read it with that one, or make it again with this one")
"""Datasets; the version is their global attribute `schema_version`, which other programs do not
write."""
CHECKPOINT = Format(1, 2, "only that one goes on from it")
"""Checkpoints. Version 1 did not record its number. Either version is used if it has the arrays of
the present State."""
