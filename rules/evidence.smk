# Published numbers beside ours: rows from each study that has an evidence.py, and all of them together.
ROWS_OF_STUDY = f"{OF_STUDY}evidence.csv"
WITH_EVIDENCE = [name for name, about in STUDIES.items() if "evidence" in about]


def data_of_evidence(wildcards):
    about = study_of(wildcards)
    return datasets_of(wildcards.study, wildcards.scale, about["evidence"])


def code_of_study_evidence(wildcards):
    return code_beside(study_of(wildcards), ["*.py", "*.csv"], "judging", "claims.published")


def names_of_evidence(wildcards):
    return study_of(wildcards)["evidence"]


rule study_evidence:
    input:
        data=data_of_evidence,
    output:
        ROWS_OF_STUDY,
    log:
        "logs/{scale}/{study}_evidence.log",
    wildcard_constraints:
        study=one_of(WITH_EVIDENCE),
    params:
        code=code_of_study_evidence,
        shows=names_of_evidence,
        folder=folder_of_study,
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps study_evidence {params.folder:q} {input.data:q}"
        " --shows {params.shows:q} --output {output:q} > {log:q} 2>&1"


rule rows_of_evidence:
    input:
        expand(ROWS_OF_STUDY, study=WITH_EVIDENCE, allow_missing=True),
    output:
        "results/{scale}/evidence.csv",
    log:
        "logs/{scale}/evidence.log",
    params:
        code=code_of("results.evidence"),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps evidence {input:q} --output {output:q} > {log:q} 2>&1"


rule page_of_evidence:
    input:
        "results/{scale}/evidence.csv",
    output:
        "results/{scale}/evidence.md",
    log:
        "logs/{scale}/evidence_page.log",
    params:
        code=code_of("results.evidence"),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps evidence_page {input:q} --output {output:q} > {log:q} 2>&1"


rule figure_of_evidence:
    input:
        lambda wildcards: f"results/{scale_of(wildcards.folder)}/evidence.csv",
    output:
        "figures/{folder}evidence.pdf",
        report(
            "figures/{folder}evidence.png",
            caption="captions/evidence.rst",
            category=catalogue.HEADINGS["beyond"],
            labels=titled(catalogue.FIGURES["evidence"].title),
        ),
    log:
        "logs/figures/{folder}evidence_figure.log",
    params:
        code=code_of("show.figures.evidence", "show.style"),
    message:
        "draw {output}"
    shell:
        "python -P -m roughgas.steps evidence_figure {input:q} --output {output:q} > {log:q} 2>&1"
