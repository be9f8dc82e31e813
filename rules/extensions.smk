# Beyond the paper: the experiments that it left for later, one table, and what they answer.


def data_of_extensions(wildcards):
    return reduced(wildcards.scale, catalogue.shown_in("beyond"))


rule table_of_extensions:
    input:
        sources("results.table"),
        data=data_of_extensions,
    output:
        report(
            "results/{scale}/extensions.csv",
            caption="captions/table.rst",
            category=catalogue.HEADINGS["beyond"],
            labels=titled("Table: every number (CSV, to download)"),
        ),
    log:
        "logs/{scale}/extensions.log",
    benchmark:
        "logs/{scale}/extensions.tsv"
    message:
        "write {output}"
    shell:
        "roughgas table {input.data} --output {output} > {log} 2>&1"


rule open_questions:
    input:
        sources("claims"),
        "src/roughgas/claims/open_questions.yaml",
        data=data_of_extensions,
    output:
        json="results/{scale}/open_questions.json",
        markdown="results/{scale}/open_questions.md",
    log:
        "logs/{scale}/open_questions.log",
    benchmark:
        "logs/{scale}/open_questions.tsv"
    message:
        "answer what the paper leaves open"
    shell:
        "roughgas claims --open-questions {input.data} --json {output.json} --markdown {output.markdown}"
        " > {log} 2>&1"


rule extensions:
    input:
        drawn(catalogue.figures_of("beyond")),
        f"results/{SCALE}/extensions.csv",
        f"results/{SCALE}/open_questions.json",
        f"results/{SCALE}/open_questions.md",
        documents("open_questions", "run_times_extensions"),
