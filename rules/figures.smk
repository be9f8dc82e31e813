# The paper: its four figures, one table, and the verdict on what it claims. How any figure is drawn.


def sources_of_figure(wildcards):
    return sources(f"show.figures.{wildcards.figure}", "show.style")


rule figure:
    # at the scale `paper` into figures/, at others into a folder below it
    input:
        sources_of_figure,
        data=data_of_figure,
    output:
        "figures/{folder}{figure}.pdf",
        report(
            "figures/{folder}{figure}.png",
            caption="captions/figure.rst",
            category=heading_of_figure,
            labels=labels_of_figure,
        ),
    log:
        "logs/figures/{folder}{figure}.log",
    benchmark:
        "logs/figures/{folder}{figure}.tsv"
    params:
        experiments=experiments_of_figure,
    message:
        "draw {wildcards.folder}{wildcards.figure}"
    shell:
        "roughgas figure {wildcards.figure} {input.data} --output {output} > {log} 2>&1"


rule table:
    input:
        sources("results.table"),
        data=data_of_paper,
    output:
        report(
            "results/{scale}/R.csv",
            caption="captions/table.rst",
            category=catalogue.HEADINGS["paper"],
            labels=titled("Table: every number (CSV, to download)"),
        ),
    log:
        "logs/{scale}/table.log",
    benchmark:
        "logs/{scale}/table.tsv"
    message:
        "write {output}"
    shell:
        "roughgas table {input.data} --output {output} > {log} 2>&1"


rule claims:
    input:
        sources("claims"),
        "src/roughgas/claims/paper.yaml",
        data=data_of_paper,
    output:
        json="results/{scale}/claims.json",
        markdown="results/{scale}/claims.md",
    log:
        "logs/{scale}/claims.log",
    benchmark:
        "logs/{scale}/claims.tsv"
    message:
        "judge the claims of the paper"
    shell:
        "roughgas claims {input.data} --json {output.json} --markdown {output.markdown} > {log} 2>&1"
