import pytest
from synthetic import BETA, reduced

from roughgas.claims.verdicts import FAILS, HOLDS, NOT_TESTED, QUALIFIED


def walls(rough=0.2, particle=0.0, smooth=0.0, beta=(-1.0, *BETA)):
    """The bed without walls, and with walls that shift R by so much at beta < 1."""

    def shift(size):
        return lambda r, beta: size * (1 - beta) + 0 * r

    return (
        reduced("vibrated"),
        reduced("vibrated_rough_walls", shift(rough), r=(0.9,), beta=beta),
        reduced("vibrated_particle_walls", shift(particle), r=(0.9,)),
        reduced("vibrated_smooth_walls", shift(smooth), r=(0.9,)),
    )


@pytest.mark.parametrize(
    ("shifts", "expected"),
    [
        ({}, HOLDS),
        ({"particle": 0.02}, QUALIFIED),
        ({"smooth": 0.15}, FAILS),
        ({"rough": 0.0}, FAILS),
        ({"rough": 0.0, "smooth": 0.2}, FAILS),
    ],
    ids=["only rough", "others a little", "smooth as much", "none", "smooth alone"],
)
def test_only_rough_walls_matter(verdicts, shifts, expected):
    assert verdicts(*walls(**shifts))["only_rough_walls_matter"].verdict == expected


@pytest.mark.parametrize(("shift", "expected"), [(0.0, HOLDS), (0.02, QUALIFIED), (0.1, FAILS)])
@pytest.mark.parametrize("kind", ["particle", "smooth"])
def test_other_walls_change_nothing(verdicts, kind, shift, expected):
    found = verdicts(*walls(**{kind: shift}))
    assert found[f"{kind}_walls_change_nothing"].verdict == expected


@pytest.mark.parametrize(
    ("shift", "expected"), [(0.2, HOLDS), (0.003, QUALIFIED), (0.0, FAILS), (-0.2, FAILS)]
)
def test_rough_walls_push_to_half(verdicts, shift, expected):
    found = verdicts(*walls(rough=shift))["rough_walls_push_to_half"]
    assert found.verdict == expected


def test_rough_walls_that_pull_somewhere_qualify(verdicts):
    bed = reduced("vibrated")
    uneven = reduced("vibrated_rough_walls", lambda r, b: 0.2 - 0.3 * (b > 0.7) + 0 * r, r=(0.9,))
    found = verdicts(bed, uneven)["rough_walls_push_to_half"]
    assert found.verdict == QUALIFIED and "R falls at 2 of 20 points" in found.reason


@pytest.mark.parametrize(
    ("shift", "expected"), [(0.3, HOLDS), (0.2515, QUALIFIED), (0.25, FAILS), (0.2, FAILS)]
)
def test_above_half_at_smooth_particles(verdicts, shift, expected):
    _, rough, _, _ = walls(rough=shift)
    rough = rough.sel(beta=[-1.0])
    exact = 2 * shift - 0.5
    rough["R"] = 0 * rough.R + 0.5 + exact
    rough["R_stderr"] = 0 * rough.R + 0.0001
    found = verdicts(rough)["rough_walls_above_half"]
    assert found.verdict == expected
    assert found.numbers[0][1].value == pytest.approx(exact)


def test_without_beta_minus_one_the_half_is_not_tested(verdicts):
    found = verdicts(*walls(beta=BETA))["rough_walls_above_half"]
    assert found.verdict == NOT_TESTED and "does not reach beta = -1" in found.reason
