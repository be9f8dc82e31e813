"""The hard cases: a catalogue in tests/hard_cases of the ways that a simulation could go wrong.

Parameters named after wildcards take their values: `folder` is empty at the scale `paper`, `family`
is a group of cases in one file, test_FAMILY.py.
"""

from pathlib import Path

from roughgas.base.files import code_of
from roughgas.show import catalogue
from roughgas.show.catalogue import figures_of

SLOW_FAMILIES = ["random_scenes", "long_times", "exact_arithmetic", "remedies"]
"""Families with long run times, which start first, in this order."""
IMPORTED_FOLDERS = ("", "brute_force", "exact", "hard_cases")
"""Folders of tests/ that a family may import from."""


class HardCases:
    """Files of the hard cases in a checkout; empty for an installed package."""

    def __init__(self, source: Path) -> None:
        """Find the files in the checkout `source`."""
        self.tests, self.folder = source / "tests", source / "tests" / "hard_cases"
        self.descriptions = self.folder / "cases.yaml"
        self.drawing = [self.folder / "report.py", self.folder / "pictures.py"]
        self.pictures = figures_of("hard_cases")

    @property
    def families(self) -> list[str]:
        """The names of all families, sorted."""
        return sorted(path.stem.removeprefix("test_") for path in self.folder.glob("test_*.py"))

    def shared_modules(self) -> list[Path]:
        """Return the modules of tests/ that a family may import."""
        return [
            path
            for folder in IMPORTED_FOLDERS
            for path in sorted(Path(self.tests, folder).glob("*.py"))
            if not path.name.startswith("test_") and path not in self.drawing
        ]

    def cases(self, family: str) -> Path:
        """Return the path of the file of the cases of a family."""
        return self.folder / f"test_{family}.py"

    def extra_inputs(self, family: str) -> list[Path]:
        """Return further input files of the job of a family.

        The family `remedies` removes safeguards from a copy of the package, and runs the cases of
        all families.
        """
        if family != "remedies":
            return []
        return [self.folder / "remedies.json", *sorted(self.folder.glob("test_*.py"))]

    @staticmethod
    def code() -> str:
        """Return the fingerprint of the code of the package that families test."""
        return code_of("simulation.point", "data", alone=["cli.run"])

    def trials_option(self, folder: str) -> str:
        """Return the option for the number of random trials: "--full" at the scale `paper`.

        At other scales it is "", for the number in the test suite. `folder` is the folder of the
        scale in figures/, "" for `paper`.
        """
        return "" if folder else "--full"

    def priority(self, family: str) -> int:
        """Return the priority of the job of a family: families with long run times start first."""
        return 10 - SLOW_FAMILIES.index(family) if family in SLOW_FAMILIES else 0


def label(picture: str) -> dict[str, str]:
    """Return the label of a picture of the hard cases in Snakemake's report: {"product": title}."""
    return {"product": catalogue.FIGURES[picture].title}
