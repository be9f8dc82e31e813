"""Event-driven simulation of gases of rough, inelastic disks and spheres."""

from roughgas.base import __version__

__all__ = [
    "__version__",
    "experiments",
    "open_points",
    "read_frame",
    "register_effect",
    "register_observable",
    "simulate",
    "trajectory",
]
TYPE_CHECKING = False  # type checkers take it as true; importing typing would be ten times slower

if TYPE_CHECKING:
    from roughgas.library import (
        experiments,
        open_points,
        read_frame,
        register_effect,
        register_observable,
        simulate,
        trajectory,
    )
else:

    def __getattr__(name: str) -> object:
        # imported lazily, since every job of the pipeline imports this package
        if name not in __all__:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        from roughgas import library

        return getattr(library, name)


def __dir__() -> list[str]:
    """Return the names of the module, the lazily imported ones included."""
    return sorted({*globals(), *__all__})
