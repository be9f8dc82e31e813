"""docs/command_line.md: its commands, and what they print.

.venv/bin/python tests/cli/page.py      writes the page's outputs anew
"""

import contextlib
import io
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from roughgas.cli import main

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "command_line.md"
BLOCK = re.compile(r"^```console\n(.*?)^```$", re.DOTALL | re.MULTILINE)
PROGRESS = re.compile(
    r"^.* s so far(?:, about \d+ s left)?\n", re.MULTILINE
)  # which a slow machine makes
WIDEST = 140
NUMBER = r"[\d.]+(?:e\+\d+)?"
MACHINE = [(rf"{NUMBER} s of CPU time, [\d,]+ a second", "some time")]
MACHINE += [(r'"kernel_seconds": [^,}]+', "some time"), (rf" in {NUMBER} s\b", " in some time")]
MACHINE += [(rf"\| +{NUMBER} (s|min|h) +", "| some time ")]
MACHINE += [(rf"[Ww]ith {NUMBER} s", "with some time")]
MACHINE += [(r"(roughgas|numpy|Python|numba|llvmlite) [\d.]+", "a version")]
MACHINE += [(r"[\d.]+e-1\d", "rounding"), (r"-+", "-")]
"""What another machine prints in another way, and in place of it."""


def blocks():
    """The page's blocks of commands and their outputs, as they are written."""
    return BLOCK.findall(PAGE.read_text(encoding="utf-8"))


def commands(block):
    return [line[2:] for line in block.splitlines() if line.startswith("$ ")]


def written(block, printed):
    """The block with its outputs made anew, in the present folder, their longest lines cut.

    `printed` gives what the command with some arguments prints.
    """
    text = ""
    for command in commands(block):
        program, *arguments = shlex.split(command)
        assert program == "roughgas"
        lines = PROGRESS.sub("", printed(arguments)).splitlines()
        text += f"$ {command}\n" + "".join(f"{cut(line)}\n" for line in lines)
    return text


def in_this_process(arguments):
    """What the command prints, quickly."""
    stream = io.StringIO()
    with contextlib.redirect_stdout(stream), contextlib.redirect_stderr(stream):
        main(arguments)
    return stream.getvalue()


def in_its_own(arguments):
    """What it prints to a person, in whose time its start counts, too."""
    command = [sys.executable, "-m", "roughgas", *arguments]
    both = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
    return subprocess.run(command, **both, text=True).stdout


def cut(line):
    return line if len(line) <= WIDEST else f"{line[: WIDEST - 4]} ..."


def without_machine(text):
    """A text without what depends on the machine, and without how columns are filled."""
    for pattern, instead in MACHINE:
        text = re.sub(pattern, instead, text)
    return [line.split() for line in text.splitlines()]


@contextlib.contextmanager
def folder():
    """A folder with the configuration, entered."""
    with tempfile.TemporaryDirectory() as path, contextlib.chdir(path):
        shutil.copy(ROOT / "config.yaml", path)
        shutil.copytree(ROOT / "studies", Path(path, "studies"))
        yield Path(path)


if __name__ == "__main__":
    with folder():
        anew = BLOCK.sub(
            lambda found: f"```console\n{written(found[1], in_its_own)}```",
            PAGE.read_text(encoding="utf-8"),
        )
    PAGE.write_text(anew, encoding="utf-8")
