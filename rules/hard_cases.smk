# Where a simulation could go wrong: the catalogue in tests/hard_cases, tried as often as it takes.
TESTS = SOURCE / "tests"
HARD_CASES = TESTS / "hard_cases"
FAMILIES = sorted(path.stem.removeprefix("test_") for path in HARD_CASES.glob("test_*.py"))
WORDS = HARD_CASES / "cases.yaml"
DRAWING = [HARD_CASES / "report.py", HARD_CASES / "pictures.py"]
SHARED = [  # what a family may import
    path
    for folder in ("", "brute_force", "exact", "hard_cases")
    for path in sorted(Path(TESTS, folder).glob("*.py"))
    if not path.name.startswith("test_") and path not in DRAWING
]
LONGEST = ["random_scenes", "long_times", "exact_arithmetic", "remedies"]  # start first
PICTURES = catalogue.figures_of("hard_cases")


def size_of_cases(wildcards):
    """As often as it takes at the scale `paper`, else as often as among the tests."""
    return "" if wildcards.folder else "--full"


def place_of_tests(wildcards, output):
    """Made from the output and therefore not recorded: results do not depend on where they are."""
    return TESTS


def cases_of_family(wildcards):
    return of_project(HARD_CASES / f"test_{wildcards.family}.py")


def others_of_family(wildcards):
    """What removes safeguards runs the cases of all families."""
    remedies = [HARD_CASES / "remedies.json", *sorted(HARD_CASES.glob("test_*.py"))]
    return of_project(*remedies) if wildcards.family == "remedies" else []


def urgency_of_family(wildcards):
    return 10 - LONGEST.index(wildcards.family) if wildcards.family in LONGEST else 0


rule family:
    # other families start while this one compiles: the kernels of all are the same few
    input:
        of_project(*SHARED, WORDS),
        others_of_family,
        cases=cases_of_family,
    output:
        "results/{folder}hard_cases/{family}.json",
    log:
        "logs/{folder}hard_cases/{family}.log",
    benchmark:
        "logs/{folder}hard_cases/{family}.tsv"
    priority: urgency_of_family
    params:
        code=code_of("simulation.point", "data", alone=["cli.run"]),
        size=size_of_cases,
    message:
        "hard cases: {wildcards.family}"
    shell:
        "python -m pytest -n0 -q -s {params.size:q} --margins {output:q} {input.cases:q}"
        " > {log:q} 2>&1"


rule catalogue:
    input:
        of_project(*DRAWING),
        families=expand("results/{{folder}}hard_cases/{family}.json", family=FAMILIES),
    output:
        table="results/{folder}hard_cases.md",
        pictures=expand("figures/{{folder}}{picture}.pdf", picture=PICTURES),
        shown=[picture(name) for name in PICTURES],
    log:
        "logs/{folder}hard_cases.log",
    params:
        code=code_of("show.style"),
        size=size_of_cases,
        tests=place_of_tests,
    message:
        "write {output.table}"
    shell:
        "PYTHONPATH={params.tests:q} python -m hard_cases.report {input.families:q} {params.size:q}"
        " --table {output.table:q} --pictures {output.pictures:q} {output.shown:q} > {log:q} 2>&1"
