"""Schedules short enough for a test: what a point is run by, besides its scene."""

STEADY = {"kind": "steady", "equilibrate": 20, "measure": 40, "sample_every": 0.25, "period": 1}
COOLING = {
    "kind": "cooling",
    "replicas": 3,
    "thermalise": 5,
    "relaxation_times": 2,
    "plateau": 20,
    "sample_every": 1,
}
