"""Snakemake in forks of one process that has imported it and read the studies: a fifth of the time
of a fresh start.

As a program, it reads lines of JSON from standard input, each with a folder, an environment, the
arguments of Snakemake and a file for all output, and answers each with an exit status.
"""

import atexit
import contextlib
import functools
import gc
import importlib
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

# what every run of Snakemake imports late
LATE = ("jsonschema", "numpy.random", "snakemake.report.html_reporter", "snakemake.storage")
LATE += ("xarray",)
ROOT = Path(__file__).parent.parent


def run(folder, environment, arguments):
    program = server()
    with tempfile.NamedTemporaryFile("r") as output:
        job = [str(folder), dict(environment), [*map(str, arguments)], output.name]
        print(json.dumps(job), file=program.stdin, flush=True)
        return int(program.stdout.readline()), output.read()


@functools.cache
def server():
    """Start the program below; it ends with its standard input, that is, with this process."""
    command = [sys.executable, __file__]
    program = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    atexit.register(program.communicate)  # which closes its input, and waits
    return program


def become_snakemake(folder, environment, arguments, output):
    """Leave the server's session, keep its imports, and run Snakemake."""
    from snakemake.cli import main

    python_path = os.environ.get("PYTHONPATH", "").split(os.pathsep)
    elsewhere = [path for path in sys.path[1:] if path not in python_path]
    os.setsid()
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    paths = environment.get("PYTHONPATH", "").split(os.pathsep)
    sys.path[:] = [folder, *filter(None, paths), *elsewhere]
    sys.argv[1:] = arguments
    for source, python_path in (
        (os.open(os.devnull, os.O_RDONLY), (0,)),
        (os.open(output, 1), (1, 2)),
    ):
        for stream in python_path:
            os.dup2(source, stream)
    main(arguments)


def prepare():
    """Import what Snakemake does, so that forks of this process need not."""
    for name in ("snakemake.cli", *LATE):
        importlib.import_module(name)
    from snakemake.executors.touch import Executor

    Executor.SLEEPING_TIME = 0.0  # a tenth of a second for each job else, for times in full seconds
    read_yaml = read_yaml_once()
    gc.freeze()  # or each fork would take long to free shared objects
    return read_yaml


def read_yaml_once():
    """Let forks know the studies' YAML, which takes half of a dry run to read; return the
    function that reads another file for them."""
    from yaml_cache import remember_yaml

    from roughgas.base.reading import read_yaml
    from roughgas.config import load

    remember_yaml()
    load(ROOT / "config.yaml")
    for name in [module for module in sys.modules if module.partition(".")[0] == "roughgas"]:
        del sys.modules[name]  # a fork imports the package on its own path
    return read_yaml


if __name__ == "__main__":
    read_yaml = prepare()
    for line in sys.stdin:
        folder, *parameters = json.loads(line)
        with contextlib.suppress(Exception):  # which the fork will meet
            read_yaml(Path(folder, "config.yaml"))
        child = os.fork()
        if not child:
            become_snakemake(folder, *parameters)
            sys.exit()
        print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
