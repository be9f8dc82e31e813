"""YAML that is read again is not parsed again, which takes ruamel.yaml a second for all studies."""

import copy
import functools
from io import StringIO

from ruamel.yaml import YAML


def remember_yaml():
    """Cache the results of `YAML.load`, which the package calls with one loader only."""
    read, last = YAML.load, [None]

    @functools.lru_cache(maxsize=500)
    def recalled(text):
        return read(last[0], StringIO(text))

    def load(self, stream):
        last[0] = self
        return copy.deepcopy(recalled(stream.read()))

    YAML.load = load
