"""Event-driven simulation of gases of rough, inelastic disks and spheres."""

from roughgas.base import __version__

__all__ = ["__version__", "experiments", "simulate", "trajectory"]
TYPE_CHECKING = False  # but for type checkers; importing typing would take ten times as long

if TYPE_CHECKING:
    from roughgas.library import experiments, simulate, trajectory
else:

    def __getattr__(name: str) -> object:
        # found only when it is asked for, since every job of the pipeline imports this package, too
        if name not in __all__:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        from roughgas import library

        return getattr(library, name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
