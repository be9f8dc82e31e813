"""The bits of results that must not change: `python -m tests.bits results` compares what is there.

bits.json has a hash of one small point of every experiment, and of ten points at the paper's scale.
What has a path below `four_phases` is the same point, but sampled every 0.25 T as the paper's beds
are, and ours once were: the file holds them so that nothing but the sampling has changed.
A change that is meant to change numbers replaces the file, and says why in the changelog:
`python -m tests.bits results --replace`.
"""

import argparse
import hashlib
import json
from pathlib import Path

import netCDF4
import numpy as np

KNOWN = Path(__file__).with_name("bits.json")
CLOCKS = ("kernel_seconds",)
# how variables begin that are newer than the file
SINCE = (
    "R_collisional",
    "R_corrected",
    "contact_correlation",
    "E_rot_stderr",
    "measured_collisions",
    "stage_",
    "collisions_series",
    "energy_input_series",
    "energy_gain_series",
    "logged_",
    "memory_of_R",
    "slowest_relaxation",
    "flow_relaxation",
    "R_flow_",
)
TRUSTED = "_trusted"  # how verdicts on errors end
VERDICTS = ("equilibrated",)  # are no numbers, and their criteria may change
FOUR_PHASES = "four_phases"


def digest(path):
    """A hash of all variables of a dataset but CPU times, verdicts, and newer ones."""
    found = hashlib.sha256()
    with netCDF4.Dataset(path) as file:
        file.set_auto_mask(False)
        names = set(file.variables) - {*CLOCKS, *VERDICTS}
        old = (name for name in names if not name.startswith(SINCE) and not name.endswith(TRUSTED))
        for name in sorted(old):
            values = np.asarray(file[name][...])
            words = "|".join(map(str, values.ravel())) if values.dtype.kind == "O" else ""
            found.update(f"{name}{values.dtype}{values.shape}{words}".encode())
            found.update(b"" if words else values.tobytes())
    return found.hexdigest()[:16]


def known():
    return json.loads(KNOWN.read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--replace", action="store_true")
    options = parser.parse_args()
    here = {name: options.folder / name for name in known()}
    found = {name: digest(path) for name, path in here.items() if path.exists()}
    if options.replace:
        KNOWN.write_text(json.dumps(known() | found, indent=1) + "\n")
    others = [name for name in found if found[name] != known()[name]]
    print(f"{len(found) - len(others)} of {len(found)} the same, {len(here) - len(found)} missing")
    print("\n".join(others), end="\n" if others else "")
    return bool(others)


if __name__ == "__main__":
    raise SystemExit(main())
