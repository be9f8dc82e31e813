"""Numbers in README and docs are those of docs/numbers.json, which is made from datasets."""

import pytest
from tests.quoted import QUOTES, ROOT, Quantity, pages, pattern, quoted, summary
from tests.quoted.measured import measured
from tests.synthetic import reduced


@pytest.mark.parametrize("path", [ROOT / name for name in QUOTES], ids=str)
def test_pages_quote_the_numbers_of_the_datasets(path):
    """If not: python -m tests.quoted FOLDER."""
    assert path.read_text(encoding="utf-8") == pages()[path]


def test_every_number_of_the_summary_is_quoted():
    assert quoted() == set(summary())


def test_numbers_as_pages_write_them():
    assert f"{Quantity(-0.0063, 0.0012):+()}" == "−0.006(1)"
    assert f"{Quantity(0.06712, 0.00096):()}" == "0.067(1)"
    assert f"{Quantity(4.18):.1f} {Quantity('five')}" == "4.2 five"
    assert (
        pattern("within {off:.1f} % of it").search("It is within 4.2\n  % of it.").group(1) == "4.2"
    )


def test_numbers_are_measured_on_datasets(tmp_path):
    axes = {
        "r": (0.9,),
        "beta": (-0.5, 0.0, 0.5),
        "third": ("floor.wave", ("sawtooth", "reversed_sawtooth", "sine", "triangle")),
    }
    waves = reduced("waves", lambda r, beta, wave: -0.01 * (wave == "sine"), error=1e-5, **axes)
    waves.to_netcdf(tmp_path / "waves.nc")
    found = {name: Quantity(**about) for name, about in measured(tmp_path).items()}
    assert f"{found['wave_sine_at_r09']:+.3f}" == "−0.010"
    assert abs(found["wave_triangle_at_r09"].value) < 1e-4 and set(found) < quoted()
