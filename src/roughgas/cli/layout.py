"""How numbers are shown in the terminal."""

from collections.abc import Mapping

from roughgas.base.layout import as_json, columns
from roughgas.statistics.estimate import Estimate, decimals_of

__all__ = ["as_json", "columns", "decimals_of", "unit_of", "with_error"]


def with_error(value: float, error: float) -> str:
    """Such as 0.3565(30), the error in units of the last digit; six digits where it has none."""
    return f"{Estimate(value, error)}"


def unit_of(attributes: Mapping[str, str]) -> str:
    """The unit of a variable with these attributes: of the gas's own ones, where it is in such."""
    return attributes.get("reduced_units", attributes["units"])
