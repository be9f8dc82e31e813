# What is made to be looked at in a browser: documents for Snakemake's report, and interactive pages.
LOOKS = sorted(
    str(path) for path in (SOURCE / "roughgas/show/page").glob("*.*") if path.suffix != ".py"
)


def points_of_paper(wildcards):
    """The datasets of all points that the paper's figures show."""
    return [
        point for name in catalogue.shown_in("paper") for point in points(wildcards.scale, name)
    ]


def points_of_extensions(wildcards):
    """The datasets of all points that the figures beyond it show."""
    return [
        point for name in catalogue.shown_in("beyond") for point in points(wildcards.scale, name)
    ]


rule document:
    input:
        sources("show.page.document"),
        LOOKS,
        shown=source_of_document,
    output:
        report(
            "results/{scale}/{document}.html",
            caption="captions/document.rst",
            category=heading_of_document,
            labels=labels_of_document,
        ),
    log:
        "logs/{scale}/{document}_html.log",
    benchmark:
        "logs/{scale}/{document}_html.tsv"
    wildcard_constraints:
        document="|".join(catalogue.DOCUMENTS),
    params:
        caption=caption_of_document,
    message:
        "write {output}"
    shell:
        "roughgas html {input.shown} --output {output} > {log} 2>&1"


rule effective_config:
    input:
        sources("config"),
        file="config.yaml",
    output:
        report(
            "results/{scale}/config.yaml",
            caption="captions/config.rst",
            category=catalogue.HEADINGS["this_run"],
            labels=titled("Configuration (YAML, to download)"),
        ),
    log:
        "logs/{scale}/config.log",
    benchmark:
        "logs/{scale}/config.tsv"
    params:
        changes=roughgas.config.as_text(CHANGES),
    message:
        "write {output}"
    shell:
        "roughgas config --config {input.file} --scale {wildcards.scale} --changes {params.changes:q}"
        " --output {output} > {log} 2>&1"


rule run_times:
    input:
        sources("results.times"),
        data=data_of_paper,
    output:
        "results/{scale}/run_times.md",
    log:
        "logs/{scale}/run_times.log",
    benchmark:
        "logs/{scale}/run_times.tsv"
    message:
        "write {output}"
    shell:
        "roughgas times {input.data} --output {output} > {log} 2>&1"


use rule run_times as run_times_of_extensions with:
    input:
        sources("results.times"),
        data=data_of_extensions,
    output:
        "results/{scale}/run_times_extensions.md",
    log:
        "logs/{scale}/run_times_extensions.log",
    benchmark:
        "logs/{scale}/run_times_extensions.tsv"


rule page:
    input:
        sources("show.page.explore"),
        LOOKS,
        points_of_paper,
        data=data_of_paper,
    output:
        "results/{scale}/explore.html",
    log:
        "logs/{scale}/explore.log",
    benchmark:
        "logs/{scale}/explore.tsv"
    message:
        "write {output}"
    shell:
        "roughgas page {input.data} --points results/{wildcards.scale} --output {output}"
        " > {log} 2>&1"


use rule page as page_of_extensions with:
    input:
        sources("show.page.explore"),
        LOOKS,
        points_of_extensions,
        data=data_of_extensions,
    output:
        "results/{scale}/explore_extensions.html",
    log:
        "logs/{scale}/explore_extensions.log",
    benchmark:
        "logs/{scale}/explore_extensions.tsv"


rule explore:
    input:
        f"results/{SCALE}/explore.html",


rule explore_extensions:
    input:
        f"results/{SCALE}/explore_extensions.html",
