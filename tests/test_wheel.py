"""The wheel and the source archive are complete; with the wheel alone, in an empty folder,
every command for people works."""

import json
import os
import shlex
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from pathlib import Path

import pytest

from roughgas.cli.commands import COMMANDS
from roughgas.compiling.cache_folders import cache_root

ROOT = Path(__file__).parent.parent
POINT = "cooling --scale small --r 0.9 --beta 0.5"
LINES = {
    "run": f"run {POINT} -o point.nc",
    "movie": f"movie {POINT} --length 2 --frames 3 -o gas.gif",
    "trajectory": f"trajectory {POINT} --times 0 1 -o gas.xyz",
    "show": "show point.nc",
    "reduce": "reduce point.nc -o cooling.nc",
    "plot": "plot cooling.nc -o R.png",
    "experiments": "experiments",
    "init": "init gases",
    "theory": "theory --r 0.9 --beta 0.5",
    "doctor": "doctor",
    "completion": "completion bash",
}


STUDIES = sorted(path.parent.name for path in ROOT.glob("studies/*/config.yaml"))
DATA = (".csv", ".css", ".html", ".js", ".json", ".py", ".typed", ".yaml")
"""Suffixes of files without which the package does not work."""
OF_PROJECT = ("CHANGELOG.md", "Snakefile", "config.yaml", "config/config.yaml", "pyproject.toml")
OF_PROJECT += ("article/metadata.yaml", "docs/cluster.md", "profiles/slurm/batches.yaml")
OF_PROJECT += ("rules/common.smk", "tests/test_wheel.py", "workflow/Snakefile")
"""Files of the source archive, of each folder that the workflow or the tests need."""
LISTING = (
    "import json, roughgas.config as config;"
    "from roughgas.config.packaged import SHIPPED;"
    "print(json.dumps(sorted(config.load(SHIPPED).studies)))"
)


def build(target, project, folder):
    """Build a `wheel` or an `sdist` of the project at `project` in `folder`; return its path."""
    command = [sys.executable, "-m", "hatchling", "build", "-t", target, "-d", str(folder)]
    subprocess.run(command, cwd=project, capture_output=True, check=True)
    (archive,) = [path for path in folder.iterdir() if path.name.endswith((".whl", ".tar.gz"))]
    return archive


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    return build("wheel", ROOT, tmp_path_factory.mktemp("wheel"))


@pytest.fixture(scope="module")
def package(wheel, tmp_path_factory):
    """A folder with the files that the wheel installs alone."""
    folder = tmp_path_factory.mktemp("package")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    return folder


def python(package, code, folder):
    """Return the output of Python for `code` in `folder`, with the package of a wheel."""
    environment = os.environ | {"PYTHONPATH": str(package), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def data_files(folder):
    """Return the paths of files in `folder`, below it, which its package does not work without."""
    paths = (path for path in folder.rglob("*") if "__pycache__" not in path.parts)
    return {str(path.relative_to(folder)) for path in paths if path.suffix in DATA}


def names_below(folder):
    """Return the paths, relative to `folder`, of all files below it."""
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


def test_the_wheel_has_all_that_the_package_reads(package):
    assert STUDIES and data_files(ROOT / "src/roughgas") <= data_files(package / "roughgas")
    assert data_files(ROOT / "studies") == data_files(package / "roughgas/studies")
    shipped = package / "roughgas/config.yaml"
    assert not shipped.is_symlink() and shipped.read_text() == (ROOT / "config.yaml").read_text()
    of_workflow = {"Snakefile", *("rules/" + name for name in names_below(ROOT / "rules"))}
    assert names_below(package / "roughgas/pipeline") == of_workflow
    siblings = [path.name for path in package.iterdir() if path.name != "roughgas"]
    assert len(siblings) == 1 and siblings[0].endswith(".dist-info")


def test_the_wheel_has_the_licences_of_all_that_it_holds(package):
    licences = [path for path in (ROOT / "src").rglob("LICENSE")]
    (described,) = package.glob("*.dist-info")
    packed = names_below(described / "licenses")
    assert licences and packed == {"LICENSE", *(str(p.relative_to(ROOT)) for p in licences)}


def test_package_indices_know_the_form_of_the_metadata(package):
    (metadata,) = package.glob("*.dist-info/METADATA")
    assert metadata.read_text().startswith("Metadata-Version: 2.4\n")


def test_the_package_of_a_wheel_is_imported_in_an_empty_folder(package, tmp_path):
    printed = python(package, "import roughgas.config as c; print(c.__file__)", tmp_path)
    assert printed.strip() == str(package / "roughgas/config/__init__.py")


@pytest.mark.slow
def test_the_package_of_a_wheel_knows_every_study(package, tmp_path):
    assert json.loads(python(package, LISTING, tmp_path)) == STUDIES


@pytest.mark.slow
def test_the_source_archive_makes_the_same_wheel(wheel, tmp_path):
    """From a file that has neither git's folder nor what git ignores."""
    archive = build("sdist", ROOT, tmp_path)
    with tarfile.open(archive) as members:
        members.extractall(tmp_path, filter="data")
    project = tmp_path / archive.name.removesuffix(".tar.gz")
    missing = [name for name in OF_PROJECT if not (project / name).exists()]
    assert missing == []
    again = build("wheel", project, tmp_path / "again")
    names, names_again = (sorted(zipfile.ZipFile(path).namelist()) for path in (wheel, again))
    assert names == names_again


@pytest.fixture(scope="module")
def installed(wheel):
    """The command `roughgas` of a wheel, in an environment that lends libraries from this one."""
    folder = wheel.parent
    subprocess.run([sys.executable, "-m", "venv", folder / "venv"], check=True)
    python = folder / "venv" / "bin" / "python"
    command = [python, "-m", "pip", "install", "-q", "--no-index", "--no-deps", wheel]
    subprocess.run(command, check=True)
    home = Path(
        subprocess.check_output(
            [python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"], text=True
        ).strip()
    )
    (home / "lent.pth").write_text(sysconfig.get_path("purelib"))  # whose own .pth are not read
    return folder / "venv" / "bin" / "roughgas"


def ran(installed, arguments, folder):
    environ = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    environ["ROUGHGAS_CACHE_DIR"] = str(cache_root())  # named by a hash of the kernels' sources
    return subprocess.run(arguments, cwd=folder, env=environ, capture_output=True, text=True)


def roughgas(installed, line, folder):
    return ran(installed, [installed, *shlex.split(line)], folder)


@pytest.mark.slow
def test_every_command_works_in_an_empty_folder(installed, tmp_path):
    assert set(COMMANDS) - {"crate"} == set(LINES)
    for name, line in LINES.items():
        done = roughgas(installed, line, tmp_path)
        assert done.returncode == 0, (name, done.stderr)
    products = {"point.nc", "gas.gif", "gas.xyz"}
    assert products <= {path.name for path in tmp_path.iterdir()}
    report = json.loads(roughgas(installed, "doctor --json", tmp_path).stdout)
    assert str(installed.parents[1]) in report["configuration"]["said"]
    done = roughgas(installed, "crate point.nc -o run.zip", tmp_path)
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    assert "must be one with the workflow" in done.stderr
    (tmp_path / "config.yaml").write_text("scales: paper\n")
    done = roughgas(installed, f"run {POINT}", tmp_path)
    assert done.returncode == 2 and done.stderr.startswith("roughgas: error: config.yaml")


@pytest.mark.slow
def test_with_a_clone_of_the_workflow_it_runs(installed, tmp_path):
    python = [installed.parent / "python", "-m", "snakemake"]
    command = [*python, "-j1", "-s", ROOT / "Snakefile", "--config", "scale=small", "--", "living"]
    done = ran(installed, command, tmp_path)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "results/small/living.html").exists()


@pytest.mark.slow
def test_a_new_project_runs_with_the_workflow_of_the_wheel(installed, tmp_path):
    """In a folder outside of any clone, from the study to its page."""
    assert roughgas(installed, "init 'my gases'", tmp_path).returncode == 0
    project = tmp_path / "my gases"
    done = ran(installed, [installed.parent / "python", "-m", "snakemake", "-j1", "mine"], project)
    assert done.returncode == 0, done.stderr
    assert (project / "figures/small/mine.sliding.png").exists()
    assert (project / "results/small/mine/page.html").exists()
    done = roughgas(installed, "run mine.sliding --r 0.9 --beta 0.5", project)
    assert done.returncode == 0 and "friction (mu 0.2)" in done.stdout
