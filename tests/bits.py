"""Hashes of results whose bits must not change: `python -m tests.bits results` compares a folder.

bits.json has a hash of one small point of every experiment, and of ten points at the paper's scale.
A path below `four_phases` is the same point, sampled every 0.25 T like the paper's beds, and ours
in the past: these hashes show that the sampling alone has changed.
A change that is meant to change numbers replaces the file, and says why in the changelog:
`python -m tests.bits results --replace`.
"""

import argparse
import hashlib
import json
from pathlib import Path

import netCDF4
import numpy as np

from roughgas.data.netcdf import attributes_of
from roughgas.data.variables import POINT_COORDINATES, third_axis

HASHES_FILE = Path(__file__).with_name("bits.json")
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
    "vertical_share",
)
TRUSTED = "_trusted"  # how verdicts on errors end
VERDICTS = ("equilibrated",)  # are no numbers, and their criteria may change
FOUR_PHASES = "four_phases"


def digest(path):
    """A hash of all variables of a dataset but CPU times, verdicts, and newer ones."""
    hasher = hashlib.sha256()
    with netCDF4.Dataset(path) as file:
        file.set_auto_mask(False)
        coordinates = {*POINT_COORDINATES, third_axis(attributes_of(file))}
        names = set(file.variables) - {*CLOCKS, *VERDICTS} - coordinates
        old = (name for name in names if not name.startswith(SINCE) and not name.endswith(TRUSTED))
        for name in sorted(old):
            values = np.asarray(file[name][...])
            words = "|".join(map(str, values.ravel())) if values.dtype.kind == "O" else ""
            hasher.update(f"{name}{values.dtype}{values.shape}{words}".encode())
            hasher.update(b"" if words else values.tobytes())
    return hasher.hexdigest()[:16]


def recorded_hashes():
    return json.loads(HASHES_FILE.read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--replace", action="store_true")
    options = parser.parse_args()
    point_files = {name: options.folder / name for name in recorded_hashes()}
    digests = {name: digest(path) for name, path in point_files.items() if path.exists()}
    if options.replace:
        HASHES_FILE.write_text(json.dumps(recorded_hashes() | digests, indent=1) + "\n")
    changed = [name for name in digests if digests[name] != recorded_hashes()[name]]
    print(
        f"{len(digests) - len(changed)} of {len(digests)} the same, "
        f"{len(point_files) - len(digests)} missing"
    )
    print("\n".join(changed), end="\n" if changed else "")
    return bool(changed)


if __name__ == "__main__":
    raise SystemExit(main())
