"""What is wrong with an installation: `roughgas doctor`."""

import json
from collections.abc import Iterator

from roughgas.doctor.checks import ANEW, CHECKS, PROBLEM, WARNING, Diagnosis, remove_stale_kernels


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
            said = " ".join(str(error).split())
            found = Diagnosis(PROBLEM, f"{type(error).__name__}: {said}", remedy)
        yield name, found
        if found.verdict == PROBLEM and remedy == ANEW:
            remedy = f"most likely because of {name}, above"
