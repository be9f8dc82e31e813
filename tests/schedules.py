"""Schedules short enough for a test, and the settings of a tiny gas."""

STEADY = {"kind": "steady", "equilibrate": 20, "measure": 40, "sample_every": 0.25, "period": 1}
COOLING = {
    "kind": "cooling",
    "replicas": 3,
    "thermalise": 5,
    "relaxation_times": 2,
    "plateau": 20,
    "sample_every": 1,
}
SPIN = {"spin": {"inertia": 0.5}}
BRIEF = COOLING | {"replicas": 2, "thermalise": 1, "relaxation_times": 1, "plateau": 5}
TINY = {"particles": 5, "box": [20, 20], "effects": SPIN, "schedule": BRIEF}
