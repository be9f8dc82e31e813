# Products of more than one study, and of a complete run: tables, pages, the article, an archive.


use rule table as table_of_extensions with:
    input:
        data=from_wildcards(run_products.data, product="extensions"),
    output:
        report(
            "results/{scale}/extensions.csv",
            caption="captions/table.rst",
            category=catalogue.HEADINGS["beyond"],
            labels={"product": "Table: every number (CSV, to download)"},
        ),
    log:
        "logs/{scale}/extensions_csv.log",


rule run_times:
    input:
        data=from_wildcards(run_products.data),
    output:
        "results/{scale}/{product}.md",
    log:
        "logs/{scale}/{product}.log",
    wildcard_constraints:
        product="run_times|run_times_extensions",
    params:
        code=code_of("results.tables"),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps run_times {input.data:q} --output {output:q} > {log:q} 2>&1"


rule quoted_numbers:
    # quoted in docs/results.md and in the article
    input:
        data=from_wildcards(run_products.numbers_data, source=SOURCE),
        claims="results/{scale}/claims.json",
    output:
        "results/{scale}/numbers.json",
    log:
        "logs/{scale}/numbers.log",
    params:
        code=code_of("claims.numbers"),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps numbers {input.data:q} --claims {input.claims:q}"
        " --output {output:q} > {log:q} 2>&1"


rule quoted_by_documentation:
    # copied to the figures, so that the documentation finds it in a clone without results
    input:
        lambda wildcards: f"results/{paths.scale_of(wildcards.folder)}/{wildcards.file}",
    output:
        "figures/{folder}{file}",
    log:
        "logs/figures/{folder}{file}.log",
    wildcard_constraints:
        file=alternatives(["evidence.csv", "numbers.json", "papers.csv"]),
    message:
        "write {output}"
    shell:
        "cp {input:q} {output:q} 2> {log:q}"


rule rows_of_evidence:
    input:
        expand("results/{{scale}}/{study}/evidence.csv", study=studies.with_evidence),
    output:
        "results/{scale}/evidence.csv",
    log:
        "logs/{scale}/evidence.log",
    params:
        code=code_of("results.row_verdicts"),
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
        code=code_of("results.evidence_page"),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps evidence_page {input:q} --output {output:q} > {log:q} 2>&1"


rule table_of_papers:
    # of other groups, each reproduced by a study
    input:
        claims=from_wildcards(run_products.papers_claims),
        data=from_wildcards(run_products.papers_data),
    output:
        table="results/{scale}/papers.csv",
        page="results/{scale}/papers.md",
    log:
        "logs/{scale}/papers.log",
    params:
        code=lambda wildcards: run_products.papers_code(),
        studies=lambda wildcards: run_products.papers_texts(),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps papers {input.claims:q} --data {input.data:q}"
        " --studies {params.studies:q} --table {output.table:q} --page {output.page:q} > {log:q} 2>&1"


rule figure_of_evidence:
    input:
        lambda wildcards: f"results/{paths.scale_of(wildcards.folder)}/evidence.csv",
    output:
        "figures/{folder}evidence.pdf",
        report(
            "figures/{folder}evidence.png",
            caption="captions/evidence.rst",
            category=catalogue.HEADINGS["beyond"],
            labels={"product": catalogue.FIGURES["evidence"].title},
        ),
    log:
        "logs/figures/{folder}evidence_figure.log",
    params:
        code=code_of("show.figures.evidence", "show.style"),
    message:
        "draw {output}"
    shell:
        "python -P -m roughgas.steps evidence_figure {input:q} --output {output:q} > {log:q} 2>&1"


rule page:
    input:
        of_pages("page/base.html", "page/explore.html", "page/theme.css", "page/explore.css"),
        of_pages("page/explore.js", "page/plots.js", "page/picture.js"),
        from_wildcards(run_products.points),
        data=from_wildcards(run_products.data),
    output:
        "results/{scale}/{product}.html",
    log:
        "logs/{scale}/{product}.log",
    wildcard_constraints:
        product="explore|explore_extensions",
    params:
        code=code_of("show.explore"),
        descriptions=from_wildcards(run_products.descriptions),
        # not recorded: their location does not affect results
        config=lambda wildcards, output: of_project(CONFIG),
        points=lambda wildcards, output: Path(output[0]).parent,
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps explore {input.data:q} --points {params.points:q} --config {params.config:q}"
        " --output {output:q} > {log:q} 2>&1"


rule living_page:
    # the same at any scale: the page limits the size of its gas
    input:
        of_pages("page/base.html", "living/page.html", "page/theme.css", "living/page.css"),
        of_project(*sorted(Path(PACKAGE, "show/living").glob("*.js"))),
        config=of_project(CONFIG),
    output:
        "results/{scale}/living.html",
    log:
        "logs/{scale}/living.log",
    params:
        code=code_of("show.living", alone=CHECKING),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps living --config {input.config:q} --output {output:q} > {log:q} 2>&1"


rule document:
    input:
        of_pages("page/base.html", "page/document.html"),
        of_pages("page/theme.css", "page/document.css"),
        shown=from_wildcards(products.document_source),
    output:
        report(
            "results/{scale}/{document}.html",
            caption="captions/document.rst",
            category=from_wildcards(products.document_heading),
            labels=from_wildcards(products.document_label),
        ),
    log:
        "logs/{scale}/{document}_html.log",
    wildcard_constraints:
        document="|".join(catalogue.DOCUMENTS),
    params:
        code=code_of("show.pages"),
        caption=unrecorded(products.document_caption),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps document {input.shown:q} --output {output:q} > {log:q} 2>&1"


rule front:
    # precedes Snakemake's report, which opens on the graph of the workflow
    input:
        of_pages("page/base.html", "page/front.html", "page/verdicts.html"),
        of_pages("page/theme.css", "page/front.css", "page/verdicts.css", "page/verdicts.js"),
        readme=of_project(f"{studies.paper.folder}/README.md"),
        figures=from_wildcards(run_products.paper_pictures),
        claims="results/{scale}/claims.json",
    output:
        "results/{scale}/report.html",
    log:
        "logs/{scale}/report.log",
    params:
        code=code_of("show.report"),
        shows=from_wildcards(studies.page_shows, study_folder=""),
        reservation=from_wildcards(studies.reservation_of_readme, study_folder=""),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps front {input.claims:q} --figures {input.figures:q}"
        " --shows {params.shows:q} --readme {input.readme:q} --reservation={params.reservation:q} --output {output:q} > {log:q} 2>&1"


rule page_of_verdicts:
    # of the paper and of all studies beyond it
    input:
        of_pages("page/base.html", "page/all_verdicts.html", "page/verdicts.html"),
        of_pages("page/theme.css", "page/document.css", "page/verdicts.css", "page/verdicts.js"),
        claims=from_wildcards(run_products.all_claims),
    output:
        "results/{scale}/verdicts.html",
    log:
        "logs/{scale}/verdicts.log",
    params:
        code=code_of("show.report"),
        studies=lambda wildcards: run_products.judged_studies(),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps verdicts {input.claims:q} --studies {params.studies:q}"
        " --output {output:q} > {log:q} 2>&1"


rule effective_config:
    input:
        of_project(*sorted(Path(PACKAGE, "config").glob("*.yaml"))),
        file=of_project(CONFIG),
    output:
        report(
            "results/{scale}/config.yaml",
            caption="captions/config.rst",
            category=catalogue.HEADINGS["this_run"],
            labels={"product": "Configuration (YAML, to download)"},
        ),
    log:
        "logs/{scale}/config.log",
    params:
        code=code_of("config", alone=CHECKING),
        changes=sorted_json({key: change for key, change in CHANGES.items() if key != "scale"}),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps effective_config {input.file:q} --scale {wildcards.scale:q}"
        " --changes {params.changes:q} --output {output:q} > {log:q} 2>&1"


rule article_pdf:
    input:
        source=of_checkout("article"),
        numbers="results/{scale}/numbers.json",
        claims="results/{scale}/claims.json",
        table="results/{scale}/R.csv",
        figures=from_wildcards(run_products.article_figures),
    output:
        "results/{scale}/article.pdf",
    log:
        "logs/{scale}/article.log",
    params:
        code=from_wildcards(run_products.article_code),
        # no input: these tables are committed, and take hours to make
        long=from_wildcards(run_products.article_tables),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps article {input.source:q} {params.long:q} --numbers {input.numbers:q} --claims {input.claims:q}"
        " --table {input.table:q} --figures {input.figures:q} --output {output:q} > {log:q} 2>&1"


rule codemeta:
    input:
        of_checkout("", "CITATION.cff"),
    output:
        "codemeta.json",
    log:
        "logs/codemeta.log",
    params:
        code=code_of("results.crate"),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps codemeta {input:q} --output {output:q} > {log:q} 2>&1"


# packed in addition to the results and figures of the paper; a deposit includes the article
PACKED = {
    "crate": [],
    "deposit": multiext(f"results/{SCALE}/", "article.pdf", "numbers.json"),
}
for name, extra_products in PACKED.items():

    rule:
        name:
            name
        input:
            lambda wildcards: of_project(
                *from_wildcards(products.files_to_pack, source=SOURCE)(wildcards)
            ),
            data=from_wildcards(studies.table_data, scale=SCALE, study_folder=""),
            tables=multiext(f"results/{SCALE}/", "R.csv", "claims.json", "claims.md"),
            figures=paths.figure_files(studies.paper.drawn, SCALE),
            more=extra_products,
        output:
            f"results/{SCALE}/{name}.zip",
        log:
            f"logs/{SCALE}/{name}.log",
        params:
            code=code_of("results.crate"),
            configuration=CONFIGURATION.text,
        message:
            "pack the run into {output}"
        shell:
            "roughgas crate {input.data:q} {input.tables:q} {input.figures:q} {input.more:q}"
            " --output {output:q} --configuration {params.configuration:q} > {log:q} 2>&1"
