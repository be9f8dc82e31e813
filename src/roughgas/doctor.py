"""What is wrong with an installation: `roughgas doctor`.

A check is a function that returns a Diagnosis; an exception that it raises is a problem, too.
Nothing is imported at the top that may be what is broken.
"""

import json
import os
import platform
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Iterator
from importlib import import_module, metadata, util
from pathlib import Path
from typing import NamedTuple

from roughgas.base import extras
from roughgas.base.files import check_place
from roughgas.base.version import __version__

OK, WARNING, PROBLEM = "ok", "warning", "problem"
ANEW = "install anew: `rm -r .venv` and `make setup` in the project's folder"
PACKAGE = Path(__file__).resolve().parent
MODULES = "numpy numba netCDF4 xarray pandas yaml ruamel.yaml jsonschema tqdm argcomplete"
CACHE = "set ROUGHGAS_CACHE_DIR to a folder that can be written and has room"
SETTINGS = {
    "particles": 36,
    "box": [20, 20],
    "effects": {"spin": {"inertia": 0.5}},
    "schedule": {"kind": "cooling", "replicas": 2, "thermalise": 1, "sample_every": 1}
    | {"relaxation_times": 1, "plateau": 20},
}
KNOWN = "0x1.e218927b3f716p-2"
TRIAL = "from roughgas.doctor import trial; print(trial())"
LONGEST = 600  # seconds to compile, on a machine that is slow and busy


class Diagnosis(NamedTuple):
    """A verdict (OK, WARNING or PROBLEM), what was seen, and what to do about it."""

    verdict: str
    said: str
    remedy: str = ""


def doctor(as_json: bool, clean: bool) -> None:
    """Print what is wrong with the installation; exit with status 1 if there is a problem.

    `clean`: only remove the compiled kernels of other versions.
    """
    if clean:
        print(remove_stale_kernels())
        return
    found = {}
    for name, diagnosis in examine():
        found[name] = diagnosis
        if not as_json:
            remedy = f"\n{'':25} -> {diagnosis.remedy}" if diagnosis.remedy else ""
            print(f"{diagnosis.verdict:8} {name:16} {diagnosis.said}{remedy}", flush=True)
    verdicts = [diagnosis.verdict for diagnosis in found.values()]
    counts = {verdict: verdicts.count(verdict) for verdict in (PROBLEM, WARNING)}
    if as_json:
        print(json.dumps({name: one._asdict() for name, one in found.items()}, indent=2))
    else:
        parts = [f"{n} {verdict}{'s' if n > 1 else ''}" for verdict, n in counts.items() if n]
        print(f"\n{', '.join(parts) or 'Nothing is wrong.'}")
    if counts[PROBLEM]:
        raise SystemExit(1)


def examine() -> Iterator[tuple[str, Diagnosis]]:
    """Yield the name and the diagnosis of each check in turn; this takes some seconds."""
    remedy = ANEW
    for name, check in CHECKS.items():
        try:
            found = check()
        except Exception as error:  # whatever a broken library raises
            if isinstance(error, ImportError) and (lacks := extras.remedy(error)):
                yield name, Diagnosis(OK, f"left out: {lacks}")
                continue
            said = " ".join(str(error).split())
            found = Diagnosis(PROBLEM, f"{type(error).__name__}: {said}", remedy)
        yield name, found
        if found.verdict == PROBLEM and remedy == ANEW:
            remedy = f"most likely because of {name}, above"


def packages() -> Diagnosis:
    """Check that all libraries can be imported, and are those of this environment."""
    homes = [sysconfig.get_path(kind) for kind in ("purelib", "platlib")]
    found = [one.origin for one in map(util.find_spec, MODULES.split()) if one and one.origin]
    strangers = [file for file in found if not any(Path(file).is_relative_to(h) for h in homes)]
    if strangers:
        remedy = f"move {strangers[0]} away, or unset PYTHONPATH"
        return Diagnosis(WARNING, f"not of this environment: {', '.join(strangers)}", remedy)
    for name in MODULES.split():
        import_module(name)
    python = f"Python {platform.python_version()}, {platform.machine()}: {sys.executable}"
    return Diagnosis(OK, f"{python}; all libraries can be imported")


def parts() -> Diagnosis:
    """Check that what extras bring can be imported, and say which are not installed."""
    lacking = extras.missing()
    for name in sorted(set(extras.EXTRAS) - set(lacking)):
        for package in extras.EXTRAS[name]:
            import_module(package)
    there = ", ".join(name for name in extras.EXTRAS if name not in lacking) or "none"
    more = f"; not installed: {', '.join(lacking)}" if lacking else ""
    return Diagnosis(OK, f"{there}{more}")


def versions() -> Diagnosis:
    """Check that what is installed is what requirements.lock pins for this machine."""
    from packaging.requirements import Requirement
    from packaging.utils import canonicalize_name

    locks = (PACKAGE.parent.parent / "requirements.lock", Path("requirements.lock").resolve())
    lock = next((path for path in locks if path.exists()), None)
    if lock is None:
        return Diagnosis(OK, "there is no requirements.lock here to compare with")
    there = {canonicalize_name(one.name): one.version for one in metadata.distributions()}
    lines = [line for line in lock.read_text(encoding="utf-8").splitlines() if line[:1].isalnum()]
    others = []
    for one in (Requirement(line.rstrip(" \\")) for line in lines):
        version = there.get(canonicalize_name(one.name))
        meant = one.marker is None or one.marker.evaluate()
        if meant and (version is None or version not in one.specifier):
            others.append(f"{one.name} {version or 'missing'} ({one.specifier} is pinned)")
    if others:
        return Diagnosis(WARNING, ", ".join(others), f"for the pinned versions, {ANEW}")
    return Diagnosis(OK, f"as pinned in {lock}")


def package() -> Diagnosis:
    """Check that the sources are those of the folder that one works in."""
    said, here = f"{__version__}, from {PACKAGE}", Path("src/roughgas").resolve()
    if here.is_dir() and here != PACKAGE:
        remedy = "use the .venv of this folder: `make setup`, then .venv/bin/roughgas"
        return Diagnosis(WARNING, f"{said}, not from this folder's {here}", remedy)
    return Diagnosis(OK, said)


def configuration() -> Diagnosis:
    """Check the configuration that commands use here, and say which it is."""
    from roughgas import config

    path = config.in_use()
    try:
        known = config.load(path)
    except (ValueError, OSError) as error:
        return Diagnosis(PROBLEM, str(error), f"correct {path}, or work in another folder")
    whose = "the one that comes with roughgas" if path == config.SHIPPED else "of this folder"
    said = f"{path.absolute()}, {whose}, with {len(known['experiments'])} experiments"
    return Diagnosis(OK, said)


def kernel_cache() -> Diagnosis:
    """Check that compiled kernels can be kept."""
    from roughgas.kernel.cache import cache_root, kernel_folder

    wanted, folder = cache_root(), kernel_folder()
    if folder.parent != wanted:
        said = f"{wanted} cannot be written; kernels are lost with temporary files, in {folder}"
        return Diagnosis(WARNING, said, CACHE)
    return _room(folder, 0.25, CACHE)


def remove_stale_kernels() -> str:
    """Remove the compiled kernels of other versions, and say how large they were."""
    from roughgas.kernel.cache import kernel_folder

    folder = kernel_folder()
    stale = [other for other in folder.parent.glob("kernels-*") if other != folder]
    size = 0
    for one in stale:
        size += sum(file.stat().st_size for file in one.rglob("*") if file.is_file()) / 2**20
        shutil.rmtree(one)
    return f"{len(stale)} folders of kernels of other versions, {size:.0f} MiB: removed"


def kernel() -> Diagnosis:
    """Check that a kernel compiles, or loads, and gives the numbers that it gives elsewhere.

    In a process of its own, as a broken kernel may crash it.
    """
    ran = _ran([sys.executable, "-c", TRIAL])
    if ran.returncode > 0:
        raise RuntimeError((ran.stderr.strip().splitlines() or ["it said nothing"])[-1])
    if ran.stdout.strip() == KNOWN:
        return Diagnosis(OK, "the trial run gives the same bits as elsewhere")
    remedy = f"remove the folder of the kernel cache; if that does not help, {ANEW}"
    if ran.returncode:
        return Diagnosis(PROBLEM, f"crashed with signal {-ran.returncode}", remedy)
    promised = platform.machine() in ("x86_64", "AMD64")
    said = "the trial run gives other bits than on other machines"
    return Diagnosis(PROBLEM if promised else WARNING, said, remedy)


def trial() -> str:
    """Return R of a small cooling gas to the last bit, the same on every x86-64 machine."""
    from roughgas.scene import build
    from roughgas.simulation.point import run_point

    point = run_point(build(SETTINGS, 0.9, 0.5), SETTINGS, 1)
    return float(point.variables["R"]).hex()


def figure() -> Diagnosis:
    """Check that a figure with letters and formulae can be drawn."""
    import matplotlib
    from matplotlib.figure import Figure

    with tempfile.TemporaryFile() as file:
        drawing = Figure()
        drawing.text(0.5, 0.5, r"$\beta$ = 0")
        drawing.savefig(file, format="png")
    return Diagnosis(OK, f"matplotlib {matplotlib.__version__}, with its own fonts")


def movie() -> Diagnosis:
    """Check that the encoder of movies is there and runs."""
    import imageio_ffmpeg

    program = imageio_ffmpeg.get_ffmpeg_exe()
    if "libx264" in _ran([program, "-hide_banner", "-encoders"]).stdout:
        return Diagnosis(OK, program)
    remedy = f"unset IMAGEIO_FFMPEG_EXE if it is set, or {ANEW}"
    return Diagnosis(PROBLEM, f"{program} cannot encode H.264", remedy)


def snakemake() -> Diagnosis:
    """Check that Snakemake can be imported, and can write its cache."""
    caches = Path(os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"))
    try:
        check_place(caches / "snakemake")
    except OSError as error:
        remedy = "Snakemake needs a place: export XDG_CACHE_HOME=(a folder that can be written)"
        return Diagnosis(PROBLEM, f"{caches}: {error.strerror}", remedy)
    return Diagnosis(OK, f"{import_module('snakemake').__version__}, cache in {caches}")


def _room(folder: Path, enough: float, remedy: str) -> Diagnosis:
    """Check that a folder can be written, and that its disk has `enough` GiB left."""
    free = shutil.disk_usage(folder).free / 2**30
    try:
        with tempfile.TemporaryFile(dir=folder) as file:
            file.write(b"room?" * 1000)
    except OSError as error:
        return Diagnosis(PROBLEM, f"{folder} cannot be written: {error.strerror}", remedy)
    if free < enough:
        return Diagnosis(WARNING, f"{folder}, only {free:.2g} GiB free", remedy)
    return Diagnosis(OK, f"{folder}, {free:.1f} GiB free")


def _ran(command: list[str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, capture_output=True, text=True, timeout=LONGEST)


CHECKS = {
    "packages": packages,
    "extras": parts,
    "versions": versions,
    "roughgas": package,
    "configuration": configuration,
    "kernel cache": kernel_cache,
    "kernel": kernel,
    "figures": figure,
    "movies": movie,
    "Snakemake": snakemake,
    "this folder": lambda: _room(Path.cwd(), 2, "make room for results: 2 GiB are enough"),
    "temporary files": lambda: _room(Path(tempfile.gettempdir()), 0.1, "set TMPDIR to a folder"),
}
