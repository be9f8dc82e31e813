# The hard cases, where a simulation could go wrong: the catalogue in tests/hard_cases, at full length.


rule family:
    # families share a few kernels, which the first family compiles.
    # The checkpoint beside the log has the finished cases, and lets an interrupted family resume;
    # progress goes to Snakemake's output, not to the log
    input:
        of_project(*cases.shared_modules(), cases.descriptions),
        lambda wildcards: of_project(*cases.extra_inputs(wildcards.family)),
        cases=lambda wildcards: of_project(cases.cases(wildcards.family)),
    output:
        "results/{folder}hard_cases/{family}.json",
    log:
        "logs/{folder}hard_cases/{family}.log",
    benchmark:
        "logs/{folder}hard_cases/{family}.tsv"
    priority: from_wildcards(cases.priority)
    params:
        code=from_wildcards(cases.code),
        size=from_wildcards(cases.trials_option),
    message:
        "hard cases: {wildcards.family}"
    shell:
        "python -m pytest -n0 -q -s {params.size:q} --margins {output:q} {input.cases:q}"
        " --checkpoint {log:q}.checkpoint.json --progress 3 3>&2 > {log:q} 2>&1"


rule catalogue:
    input:
        of_checkout("tests/hard_cases", "cases.yaml"),
        of_project(*cases.drawing),
        families=expand("results/{{folder}}hard_cases/{family}.json", family=cases.families),
    output:
        table="results/{folder}hard_cases.md",
        pictures=expand("figures/{{folder}}{picture}.pdf", picture=cases.pictures),
        shown=[
            report(
                f"figures/{{folder}}{picture}.png",
                caption=f"captions/{picture}.rst",
                category=catalogue.HEADINGS["hard_cases"],
                labels=hard_cases.label(picture),
            )
            for picture in cases.pictures
        ],
    log:
        "logs/{folder}hard_cases.log",
    params:
        code=code_of("show.style"),
        size=from_wildcards(cases.trials_option),
        tests=unrecorded(lambda: cases.tests),  # their location does not affect results
    message:
        "write {output.table}"
    shell:
        "PYTHONPATH={params.tests:q} python -m hard_cases.report {input.families:q} {params.size:q}"
        " --table {output.table:q} --pictures {output.pictures:q} {output.shown:q} > {log:q} 2>&1"
