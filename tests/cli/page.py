"""docs/command_line.md: its commands, and their outputs.

.venv/bin/python tests/cli/page.py      rewrites the outputs in the page
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
)  # printed on slow machines
MAX_WIDTH = 140
NUMBER = r"[\d.]+(?:e\+\d+)?"
MACHINE_DEPENDENT = [(rf"{NUMBER} s of CPU time, [\d,]+ a second", "some time")]
MACHINE_DEPENDENT += [
    (r'"kernel_seconds": [^,}]+', "some time"),
    (rf" in {NUMBER} s\b", " in some time"),
]
MACHINE_DEPENDENT += [(rf"\| +{NUMBER} (s|min|h) +", "| some time ")]
MACHINE_DEPENDENT += [(rf"[Ww]ith {NUMBER} s", "with some time")]
MACHINE_DEPENDENT += [(r"(roughgas|numpy|Python|numba|llvmlite) [\d.]+", "a version")]
MACHINE_DEPENDENT += [(r"[\d.]+e-1\d", "rounding"), (r"-+", "-")]
"""Patterns of text that depends on the machine, and their replacements."""


def blocks():
    """Return the page's blocks of commands and outputs, verbatim."""
    return BLOCK.findall(PAGE.read_text(encoding="utf-8"))


def commands(block):
    return [line[2:] for line in block.splitlines() if line.startswith("$ ")]


def with_outputs(block, output_of):
    """Return a block with new outputs, from commands in the present folder, with long lines cut.

    `output_of` returns the output for the arguments of a command.
    """
    text = ""
    for command in commands(block):
        program, *arguments = shlex.split(command)
        assert program == "roughgas"
        lines = PROGRESS.sub("", output_of(arguments)).splitlines()
        text += f"$ {command}\n" + "".join(f"{cut(line)}\n" for line in lines)
    return text


def in_this_process(arguments):
    """Return the output of the command, run in this process, which is fast."""
    stream = io.StringIO()
    with contextlib.redirect_stdout(stream), contextlib.redirect_stderr(stream):
        main(arguments)
    return stream.getvalue()


def in_new_process(arguments):
    """Return the output of the command, run in a new process, with its true run time."""
    command = [sys.executable, "-m", "roughgas", *arguments]
    both = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
    return subprocess.run(command, **both, text=True).stdout


def cut(line):
    return line if len(line) <= MAX_WIDTH else f"{line[: MAX_WIDTH - 4]} ..."


def comparable_lines(text):
    """Return the words of each line, without spacing and with machine-dependent text replaced."""
    for pattern, replacement in MACHINE_DEPENDENT:
        text = re.sub(pattern, replacement, text)
    return [line.split() for line in text.splitlines()]


@contextlib.contextmanager
def folder():
    """Enter a temporary folder with the configuration and the studies."""
    with tempfile.TemporaryDirectory() as path, contextlib.chdir(path):
        shutil.copy(ROOT / "config.yaml", path)
        shutil.copytree(ROOT / "studies", Path(path, "studies"))
        yield Path(path)


if __name__ == "__main__":
    with folder():
        rewritten = BLOCK.sub(
            lambda match: f"```console\n{with_outputs(match[1], in_new_process)}```",
            PAGE.read_text(encoding="utf-8"),
        )
    PAGE.write_text(rewritten, encoding="utf-8")
