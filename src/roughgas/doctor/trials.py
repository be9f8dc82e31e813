"""A little of all that the pipeline does, tried out."""

import hashlib
import os
import platform
import subprocess
import sys
import tempfile
from pathlib import Path

from roughgas.base.files import check_place
from roughgas.doctor.finding import OK, PROBLEM, WARNING, Finding
from roughgas.doctor.installation import ANEW, PROMISED

PARTICLES = 36
SETTINGS = {"particles": PARTICLES, "box": [20, 20], "effects": {"spin": {"inertia": 0.5}}}
KNOWN = "1be168e3486b81f8"
REDO = "remove the folder of the kernel cache; if that does not help, " + ANEW
PROGRAM = "from roughgas.doctor.trials import fingerprint; print(fingerprint())"
LONGEST = 600  # seconds to compile, on a machine that is slow and busy


def kernel() -> Finding:
    """Whether a kernel is compiled, or loaded, and gives the numbers that it gives elsewhere.

    In a process of its own, since a broken one may take its process along.
    """
    ran = subprocess.run(
        [sys.executable, "-c", PROGRAM], capture_output=True, text=True, timeout=LONGEST
    )
    if ran.returncode < 0:
        return Finding(PROBLEM, f"crashed with signal {-ran.returncode}", REDO)
    if ran.returncode:
        raise RuntimeError(_last_line(ran.stderr))
    if ran.stdout.strip() != KNOWN:
        said = "the trial run gives other bits than on other machines"
        promised = platform.machine() in PROMISED
        return Finding(PROBLEM, said, REDO) if promised else Finding(WARNING, said)
    said = "the trial run gives the same bits as elsewhere"
    if ran.stderr:  # that it could not be kept
        return Finding(WARNING, f"{said}; {_last_line(ran.stderr)}", "see kernel cache above")
    return Finding(OK, said)


def fingerprint() -> str:
    """Hash of what a small cooling gas does, which is the same on every x86-64 machine.

    All of its start is exact, lest it depend on how numpy draws numbers.
    """
    import numpy as np

    from roughgas.kernel.layout import new_state
    from roughgas.kernel.record import Sampling, columns, record
    from roughgas.scene import build
    from roughgas.scene.initial import lattice

    scene = build(SETTINGS, 0.9, 0.3)
    position = lattice(scene, SETTINGS)[:PARTICLES]
    numbers = np.arange(2 * PARTICLES).reshape(position.shape)
    velocity = (numbers * 37 % 101 - 50) / 32.0
    state = new_state(scene, position, velocity, np.zeros((PARTICLES, 1)))
    rows = np.empty((10, len(columns(2, True))))
    record(state, scene, Sampling(np.inf, 100, 0), rows)
    return hashlib.sha256(rows.tobytes()).hexdigest()[:16]


def dataset() -> Finding:
    """Whether a dataset that is written can be read."""
    import netCDF4

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "trial.nc")
        with netCDF4.Dataset(path, "w") as file:
            file.createVariable("R", "f8")[...] = 0.5
        with netCDF4.Dataset(path) as file:
            same = file["R"][...] == 0.5
    said = f"netCDF {netCDF4.__netcdf4libversion__}, HDF5 {netCDF4.__hdf5libversion__}"
    return Finding(OK, said) if same else Finding(PROBLEM, f"{said}: read is not written", ANEW)


def figure() -> Finding:
    """Whether a figure with letters and formulae can be drawn."""
    import matplotlib
    from matplotlib.figure import Figure

    from roughgas.show.style import PARAMETERS

    with tempfile.TemporaryDirectory() as folder, matplotlib.rc_context(PARAMETERS):
        drawing = Figure()
        drawing.text(0.5, 0.5, r"$\beta$ = 0")
        drawing.savefig(Path(folder, "trial.png"))
    return Finding(OK, f"matplotlib {matplotlib.__version__}, which brings its fonts")


def movie() -> Finding:
    """Whether the encoder of movies is there and runs."""
    import imageio_ffmpeg

    program = imageio_ffmpeg.get_ffmpeg_exe()
    ran = subprocess.run([program, "-hide_banner", "-encoders"], capture_output=True, text=True)
    if "libx264" not in ran.stdout:
        remedy = f"unset IMAGEIO_FFMPEG_EXE if it is set, or {ANEW}"
        return Finding(PROBLEM, f"{program} cannot encode H.264", remedy)
    return Finding(OK, program)


def configuration() -> Finding:
    """Whether the configuration of this folder is legal."""
    from roughgas import config
    from roughgas.base.errors import InputError

    if not Path("config.yaml").exists():
        return Finding(OK, "there is none in this folder: go to the project's to run experiments")
    try:
        loaded = config.load("config.yaml")
    except InputError as error:
        return Finding(PROBLEM, str(error), "correct it")
    return Finding(OK, f"{len(loaded['experiments'])} experiments, scale {loaded['scale']}")


def snakemake() -> Finding:
    """Whether Snakemake runs, and is the one of this environment."""
    program = Path(sys.executable).with_name("snakemake")
    if not program.exists():
        return Finding(PROBLEM, f"there is no {program}", "`make setup`")
    ran = subprocess.run([program, "--version"], capture_output=True, text=True)
    if ran.returncode:
        return Finding(PROBLEM, f"{program}: {_last_line(ran.stderr)}", ANEW)
    caches = Path(os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"))
    try:
        check_place(caches / "snakemake")
    except OSError as error:
        remedy = "Snakemake needs a place: export XDG_CACHE_HOME=(a folder that can be written)"
        return Finding(PROBLEM, f"{caches}: {error.strerror}", remedy)
    return Finding(OK, f"{ran.stdout.strip()}: {program}")


def _last_line(text: str) -> str:
    return (text.strip().splitlines() or ["(it said nothing)"])[-1]
