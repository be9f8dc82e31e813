"""What Snakemake would run again after each of several edits, found by one process.

    python edits.py TARGET... < EDITS.json

Runs in the folder of a project that is finished at the scale `tiny`. EDITS is a list of {file:
line}: the lines are added to the files, a dry run made, and the files restored. Prints, for each
edit, a list of what would run: figures and studies by their names, everything else by its rule.
"""

import json
import os
import re
import sys
import tempfile
from pathlib import Path

from snakemake.cli import main

import roughgas.simulation.point
import roughgas.studies.accuracy  # noqa: F401  (imported once, before the forks)

COMMAND = ["-n", "--config", "scale=tiny", "--", *sys.argv[1:]]


def dry_run():
    """Return the output of a dry run in a process of its own."""
    with tempfile.TemporaryFile("w+") as output:
        child = os.fork()
        if not child:
            os.dup2(output.fileno(), 1)
            os.dup2(output.fileno(), 2)
            try:
                main(COMMAND)
            finally:
                sys.stdout.flush()
                os._exit(0)
        os.waitpid(child, 0)
        output.seek(0)
        return output.read()


def planned(output):
    """Return what a dry run lists: figures and studies by their names, jobs else by their rules."""
    if "Nothing to be done" in output:
        return []
    table = output.rsplit("Job stats:", 1)[1].split("total")[0]
    rules = {
        re.sub(r"\w+_block_\d+", "seeds", rule) for rule in re.findall(r"^(\w+) +\d+$", table, re.M)
    }
    named = re.findall(r"Job \d+: (?:draw tiny/|accuracy, )(\w+)", output)
    targets = {"figure", "study_figure", "study", *sys.argv[1:]}
    return sorted({*rules, *named} - targets)


def after(edit):
    """Return what would run again after an edit."""
    before = {Path(file): Path(file).read_bytes() for file in edit}
    for path, line in zip(before, edit.values(), strict=True):
        path.write_bytes(before[path] + line.encode())
    try:
        return planned(dry_run())
    finally:
        for path, content in before.items():
            path.write_bytes(content)


if __name__ == "__main__":
    for edit in json.load(sys.stdin):
        print(json.dumps(after(edit)), flush=True)
