"""The images of Dockerfile and Apptainer.def hold all files of the workflow and its rules.

No image is built: the files are copied into a folder, and used there.
"""

import json
import os
import re
import shutil
import subprocess
import sys
from fnmatch import fnmatch
from pathlib import PurePath

import pytest
import snakemakes
from project import ROOT

STUDIES = sorted(path.parent.name for path in ROOT.glob("studies/*/config.yaml"))
TARGETS = ("figures", "friction", "extensions", "papers", "article", "numbers", "accuracy")
TARGETS += ("hard_cases", "crate")
BUILD_WHEEL = "import hatchling.build as backend, sys; backend.build_editable(sys.argv[1])"
LIST_STUDIES = (
    "import json; from roughgas.config import load; from roughgas.config.packaged import SHIPPED;"
    "print(json.dumps(sorted(load(SHIPPED).studies)))"
)


def is_hidden(path, patterns):
    """Return whether .dockerignore keeps a path, relative to the project, out of the image."""
    components = PurePath(path).parts
    heads = ["/".join(components[:length]) for length in range(1, len(components) + 1)]

    def hides(pattern):
        if pattern.startswith("**/"):
            return any(fnmatch(component, pattern[3:]) for component in components)
        depth = pattern.count("/")
        return any(fnmatch(head, pattern) for head in heads if head.count("/") == depth)

    return any(map(hides, patterns))


def copy(source, target, *, hiding=(), symlinks=False):
    """Copy a file or folder of the project to `target`, except paths that match `hiding`."""

    def hidden_names(folder, names):
        relative = PurePath(folder).relative_to(ROOT)
        return [name for name in names if is_hidden(relative / name, hiding)]

    target.parent.mkdir(parents=True, exist_ok=True)
    if is_hidden(source, hiding):
        return
    if (ROOT / source).is_dir():
        shutil.copytree(ROOT / source, target, symlinks=symlinks, ignore=hidden_names)
    else:
        shutil.copy2(ROOT / source, target)


def copies_of_docker():
    """Yield (source, target) of each copy in Dockerfile, both relative to the project."""
    lines = re.findall(r"^COPY (?:--\S+ )*(.+) (\S+)$", (ROOT / "Dockerfile").read_text(), re.M)
    for sources, target in lines:
        for source in sources.split():
            yield source, PurePath(target, source) if target.endswith("/") else PurePath(target)


def copies_of_apptainer():
    """Yield (source, target) of each line of %files, both relative to the project."""
    text = (ROOT / "Apptainer.def").read_text()
    (section,) = re.findall(r"^%files\n((?: +\S.*\n)+)", text, re.M)
    for source, target in map(str.split, section.splitlines()):
        yield source, PurePath(target).relative_to("/roughgas")


@pytest.fixture(scope="module")
def in_docker(tmp_path_factory):
    """A folder with all files that Dockerfile copies."""
    folder = tmp_path_factory.mktemp("docker")
    lines = (ROOT / ".dockerignore").read_text().splitlines()
    patterns = [line for line in lines if line and not line.startswith("#")]
    for source, target in copies_of_docker():
        copy(source, folder / target, hiding=patterns, symlinks=True)
    return folder


@pytest.fixture(scope="module")
def in_apptainer(tmp_path_factory):
    """A folder with all files of the section %files of Apptainer.def, which follows links."""
    folder = tmp_path_factory.mktemp("apptainer")
    for source, target in copies_of_apptainer():
        copy(source, folder / target)
    return folder


def python(folder, code, *arguments):
    """Return the output of Python code, run in a folder with the package of that folder."""
    command = [sys.executable, "-c", code, *map(str, arguments)]
    environment = os.environ | {"PYTHONPATH": str(folder / "src")}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize(
    ("path", "hidden"),
    [
        ("results", True),
        ("results/paper/R.csv", True),
        ("src/roughgas/results/reduce.py", False),
        ("src/roughgas/__pycache__/steps.pyc", True),
        (".venv-slurm/bin", True),
        ("docs/_build/index.html", True),
        ("docs/results.md", False),
    ],
)
def test_products_are_not_sent_to_the_build_of_the_image(path, hidden):
    patterns = (ROOT / ".dockerignore").read_text().splitlines()[1:]
    assert is_hidden(path, patterns) == hidden


@pytest.mark.slow
def test_the_image_of_docker_plans_every_target(in_docker):
    environment = os.environ | {"PYTHONPATH": str(in_docker / "src")}
    command = ("-n", "--config", "scale=small", "--", *TARGETS)
    status, output = snakemakes.run(in_docker, environment, command)
    assert status == 0, output
    with_page = [name for name in STUDIES if name not in ("paper", "accuracy", "coverage")]
    assert with_page and all(f"results/small/{name}/page.html" in output for name in with_page)


@pytest.mark.slow
@pytest.mark.parametrize("image", ["in_docker", "in_apptainer"])
def test_the_package_of_an_image_is_installed_and_has_its_data(image, request, tmp_path):
    folder = request.getfixturevalue(image)
    python(folder, BUILD_WHEEL, tmp_path)
    assert [path.suffix for path in tmp_path.iterdir()] == [".whl"]
    assert json.loads(python(folder, LIST_STUDIES)) == STUDIES


def test_the_image_of_apptainer_has_all_files_of_the_package(in_apptainer):
    paths = [path for path in (ROOT / "src").rglob("*") if path.suffix in (".yaml", ".js", ".py")]
    assert all((in_apptainer / path.relative_to(ROOT)).is_file() for path in paths)
