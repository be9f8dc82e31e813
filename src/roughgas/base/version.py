"""The version of this package, in one place; `roughgas.__version__` is the same."""

__version__ = "0.1.0"
