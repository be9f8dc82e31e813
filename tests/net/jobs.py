"""Snakemake with a summary that prints each job of the graph as a line of JSON, and runs none:
`python jobs.py -D -- TARGET ...`.

The lines have the params of jobs, which the summary of `snakemake -D` lacks.
"""

import json
import shlex
import sys

from snakemake.cli import main
from snakemake.dag import DAG

CODE_PARAM = "code"
"""The param with the hash of the code of a result, which changes with every edit."""
ARCHIVING_RULES = ("crate", "deposit")
"""Rules with all files of the project as inputs."""
MAX_LENGTH = 100
"""Length of a param above which its name replaces it in the command of a job."""


async def jobs_of(graph, detailed=False):
    """Yield each job of the graph as a line of JSON."""
    for job in graph.jobs:
        archiving = job.rule.name in ARCHIVING_RULES and job.output
        files = {"rule": job.rule.name, "output": list(map(str, job.output))}
        yield json.dumps(files if archiving else files | record_of(job))


def record_of(job):
    """Return the record of a job: inputs, params, command, and so on."""
    params = {name: value for name, value in job.params.items() if name != CODE_PARAM}
    return {
        "wildcards": job.wildcards_dict,
        "input": sorted(map(str, job.input)),
        "log": list(map(str, job.log)),
        "benchmark": str(job.benchmark),
        "params": {name: as_json_value(value) for name, value in params.items()},
        "priority": job.rule.expand_priority(job.wildcards_dict, job.input, job.attempt),
        "message": job.message,
        "command": command_of(job, params),
    }


def command_of(job, params):
    """Return the command of a job, with long params replaced by their names."""
    command = job.shellcmd or ""
    for name, value in params.items():
        if isinstance(value, str) and len(value) > MAX_LENGTH:
            command = command.replace(shlex.quote(value), f"{{params.{name}}}")
    return command


def as_json_value(value):
    """Return a param as a JSON value; objects become text."""
    if isinstance(value, list | tuple):
        return [as_json_value(inner) for inner in value]
    if isinstance(value, dict):
        return {str(key): as_json_value(inner) for key, inner in value.items()}
    return value if isinstance(value, str | int | float | None) else str(value)


if __name__ == "__main__":
    DAG.summary = jobs_of
    main(sys.argv[1:])
