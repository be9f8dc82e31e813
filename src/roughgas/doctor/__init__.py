"""What is wrong with an installation: `roughgas doctor`.

A check is a function without arguments that returns a Finding; what it raises is a problem, too.
Nothing is imported here that may be what is broken.
"""

import json
from collections.abc import Callable, Iterator

from roughgas.doctor import installation, machine, trials
from roughgas.doctor.finding import OK, PROBLEM, WARNING, Finding

__all__ = ["CHECKS", "OK", "PROBLEM", "WARNING", "Finding", "examine", "in_words", "summary"]

CHECKS: dict[str, Callable[[], Finding]] = {
    "Python": installation.python,
    "packages": installation.packages,
    "versions": installation.versions,
    "roughgas": installation.package,
    "environment": installation.environment,
    "kernel cache": machine.kernel_cache,
    "kernel": trials.kernel,
    "datasets": trials.dataset,
    "figures": trials.figure,
    "movies": trials.movie,
    "config.yaml": trials.configuration,
    "Snakemake": trials.snakemake,
    "this folder": machine.this_folder,
    "temporary files": machine.temporary_files,
    "machine": machine.cores_and_memory,
    "Slurm": machine.slurm,
}


def examine() -> Iterator[tuple[str, Finding]]:
    """The name and the finding of each check, one after the other; takes some seconds."""
    remedy = installation.ANEW
    for name, check in CHECKS.items():
        try:
            found = check()
        except Exception as error:  # what a broken library raises is what is looked for
            said = " ".join(str(error).split())
            found = Finding(PROBLEM, f"{type(error).__name__}: {said}", remedy)
        yield name, found
        if found.verdict == PROBLEM and remedy == installation.ANEW:
            remedy = f"most likely because of {name}, above"


def in_words(name: str, finding: Finding) -> str:
    """A line for a finding, and another one for what to do about it."""
    line = f"{finding.verdict:8} {name:16} {finding.said}"
    return f"{line}\n{'':25} -> {finding.remedy}" if finding.remedy else line


def summary(findings: list[Finding]) -> str:
    """How many problems and warnings there are, as the last line."""
    verdicts = [finding.verdict for finding in findings]
    counts = {verdict: verdicts.count(verdict) for verdict in (PROBLEM, WARNING)}
    parts = [f"{n} {verdict}{'s' if n > 1 else ''}" for verdict, n in counts.items() if n]
    return ", ".join(parts) if parts else "Nothing is wrong."


def doctor(as_json: bool, clean: bool) -> None:
    """Print what is wrong with the installation; exit with status 1 if there is a problem.

    `clean`: only remove the compiled kernels of other versions.
    """
    if clean:
        print(machine.clean())
        return
    found = {}
    for name, finding in examine():
        found[name] = finding
        if not as_json:
            print(in_words(name, finding), flush=True)
    if as_json:
        print(json.dumps({name: finding._asdict() for name, finding in found.items()}, indent=2))
    else:
        print(f"\n{summary(list(found.values()))}")
    if any(finding.verdict == PROBLEM for finding in found.values()):
        raise SystemExit(1)
