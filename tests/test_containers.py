"""The recipes of containers fit the project. That their commands work takes a network and minutes:
docs/data.md says how to build one."""

import fnmatch
import re
import shlex
import subprocess
from pathlib import Path

import pytest

from roughgas.results.crate import project_files

ROOT = Path(__file__).parents[1]


def steps():
    """The (instruction, text) of the Dockerfile, in order."""
    text = (ROOT / "Dockerfile").read_text()
    lines = re.sub(r"^#.*\n", "", text, flags=re.MULTILINE).replace("\\\n", " ").splitlines()
    return [tuple(line.split(None, 1)) for line in lines if line.strip()]


def texts(instruction):
    return [text for name, text in steps() if name == instruction]


def copied(text):
    """Sources and target of a COPY."""
    *sources, target = [word for word in shlex.split(text) if not word.startswith("--")]
    return sources, target


def apptainer(section):
    text = (ROOT / "Apptainer.def").read_text()
    found = re.search(rf"^%{section}\n((?:    .*\n|\n)+)", text, re.MULTILINE)[1]
    return [line.strip() for line in found.splitlines() if line.strip()]


def tracked():
    command = ["git", "-C", ROOT, "ls-files"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("no git checkout")
    return done.stdout.splitlines()


def test_everything_copied_is_in_the_repository_and_sent_to_the_builder():
    files = tracked()
    ignored = (ROOT / ".dockerignore").read_text().splitlines()[1:]
    sources = [source for text in texts("COPY") for source in copied(text)[0]]
    sources += [line.split()[0] for line in apptainer("files")]
    for source in sources:
        assert any(file == source or file.startswith(f"{source}/") for file in files), source
        assert not any(fnmatch.fnmatch(source, pattern) for pattern in ignored), source


def test_the_image_holds_all_that_a_run_consists_of():
    inside = [source for text in texts("COPY") for source in copied(text)[0]]
    for name in project_files(ROOT):
        assert name in inside or name.split("/")[0] in inside, name
    for text in texts("COPY"):
        sources, target = copied(text)
        assert target == "./" or sources == [target]
