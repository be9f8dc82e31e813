import pytest

SPIN = {"spin": {"inertia": 0.5}}
SHEARED = {
    "particles": 16,
    "box": [16, 16],
    "effects": SPIN | {"shear": {"velocity": 1}, "contact_averages": {}},
    "schedule": {"kind": "steady", "sample_every": 1},
    "target_stderr": 0.01,
}
COOLING = {
    "particles": 16,
    "box": [30, 30],
    "effects": SPIN,
    "schedule": {"kind": "cooling", "thermalise": 10, "sample_every": 1},
    "target_stderr": 0.01,
}
EXPERIMENTS = {"sheared": SHEARED, "cooling": COOLING}


@pytest.fixture
def sheared():
    """A small sheared gas with a target."""
    return SHEARED


@pytest.fixture
def cooling():
    """A small cooling gas with a target."""
    return COOLING
