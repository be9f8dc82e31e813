# What `snakemake --report` shows, and under which headings: the catalogue of figures says so. Captions
# are in captions/; those of figures add the parameters of this run.
from roughgas.results.products import project_files

OF_DOCUMENTS = ("base.html", "document.html", "document.css")
OF_FRONT = ("base.html", "front.html", "front.css")


def titled(title):
    """The labels of a product in the report."""
    return {"product": title}


def picture(name):
    """A picture among the hard cases, for the report."""
    return report(
        f"figures/{{folder}}{name}.png",
        caption=f"captions/{name}.rst",
        category=catalogue.HEADINGS["hard_cases"],
        labels=titled(catalogue.FIGURES[name].title),
    )


def entry_of(wildcards):
    """The entry in the catalogue of a figure or a document."""
    if "document" in wildcards.keys():
        return catalogue.DOCUMENTS[wildcards.document]
    return catalogue.FIGURES[wildcards.get("figure") or wildcards.study_figure]


def heading_of(wildcards):
    return entry_of(wildcards).heading


def labels_of(wildcards):
    return titled(entry_of(wildcards).title)


def source_of_document(wildcards):
    shown = entry_of(wildcards).source
    return shown.format(scale=wildcards.scale, folder=folder_of(wildcards.scale))


def caption_of_document(wildcards, output):
    """Made from the output and therefore not recorded, like the settings below: a new caption is no
    reason to write the page again."""
    return entry_of(wildcards).caption


def caption_of_figure(wildcards, output):
    """The text of captions/NAME.rst, which lies beside the Snakefile, wherever that is."""
    name = wildcards.get("figure") or wildcards.study_figure
    with one_line():
        return (SOURCE / f"rules/captions/{name}.rst").read_text("utf-8")


def described(scale, experiments):
    """The settings of experiments, for a caption."""
    found = {name: settings(scale, name) for name in experiments}
    return {
        name: one | {"description": in_rst(one.get("description", ""))}
        for name, one in found.items()
    }


def experiments_of_figure(wildcards, output):
    """The settings of the experiments that a figure shows, for its caption."""
    return described(scale_of(wildcards.folder), entry_of(wildcards).shows)


def documents(*names):
    """The documents of these names at the scale of this run."""
    return [f"results/{SCALE}/{name}.html" for name in names]


rule document:
    input:
        of_project(*(f"{PACKAGE}/show/page/{name}" for name in OF_DOCUMENTS)),
        shown=source_of_document,
    output:
        report(
            "results/{scale}/{document}.html",
            caption="captions/document.rst",
            category=heading_of,
            labels=labels_of,
        ),
    log:
        "logs/{scale}/{document}_html.log",
    wildcard_constraints:
        document="|".join(catalogue.DOCUMENTS),
    params:
        code=code_of("show.pages"),
        caption=caption_of_document,
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps document {input.shown:q} --output {output:q} > {log:q} 2>&1"


def pictures_of_paper(wildcards):
    return drawn(catalogue.figures_of("paper"), [".png"], wildcards.scale)


rule front:
    # stands in front of Snakemake's report, which opens on the graph of the workflow
    input:
        of_project(*(f"{PACKAGE}/show/page/{name}" for name in OF_FRONT)),
        captions=of_project(
            *(SOURCE / f"rules/captions/{name}.rst" for name in catalogue.figures_of("paper"))
        ),
        figures=pictures_of_paper,
        claims="results/{scale}/claims.md",
    output:
        "results/{scale}/report.html",
    log:
        "logs/{scale}/report.log",
    params:
        code=code_of("show.pages"),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps front {input.claims:q} --figures {input.figures:q}"
        " --captions {input.captions:q} --output {output:q} > {log:q} 2>&1"


rule effective_config:
    input:
        of_project(*sorted(Path(PACKAGE, "config").glob("*.yaml"))),
        file=of_project(CONFIG),
    output:
        report(
            "results/{scale}/config.yaml",
            caption="captions/config.rst",
            category=catalogue.HEADINGS["this_run"],
            labels=titled("Configuration (YAML, to download)"),
        ),
    log:
        "logs/{scale}/config.log",
    params:
        code=code_of("config"),
        changes=roughgas.config.as_text(CHANGES),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps effective_config {input.file:q} --scale {wildcards.scale:q}"
        " --changes {params.changes:q} --output {output:q} > {log:q} 2>&1"


def figures_of_article(wildcards):
    return drawn(catalogue.figures_of("paper"), [".pdf"], wildcards.scale)


rule article_pdf:
    input:
        source=of_project(*sorted((SOURCE / "article").glob("*.*"))),
        numbers="results/{scale}/numbers.json",
        claims="results/{scale}/claims.json",
        table="results/{scale}/R.csv",
        figures=figures_of_article,
    output:
        "results/{scale}/article.pdf",
    log:
        "logs/{scale}/article.log",
    params:
        code=code_of("results.article"),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps article {input.source:q} --numbers {input.numbers:q} --claims {input.claims:q}"
        " --table {input.table:q} --figures {input.figures:q} --output {output:q} > {log:q} 2>&1"


rule codemeta:
    input:
        of_project(SOURCE / "CITATION.cff"),
    output:
        "codemeta.json",
    log:
        "logs/codemeta.log",
    params:
        code=code_of("results.products"),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps codemeta {input:q} --output {output:q} > {log:q} 2>&1"


def data_of_run(wildcards):
    return reduced(SCALE, catalogue.shown_in("paper"))


def files_of_project(wildcards):
    """What a crate packs besides results; ends the workflow where that is in another folder."""
    with one_line():
        if SOURCE != Path():
            raise InputError("folder", os.getcwd(), f"be {SOURCE.resolve()}, which a crate packs")
    return of_project(*project_files())


# what is packed besides results and figures of the paper: in a deposit, all that the article rests on
PACKED = {
    "crate": [],
    "deposit": multiext(f"results/{SCALE}/", "article.pdf", "numbers.json"),
}
for name, more in PACKED.items():

    rule:
        name:
            name
        input:
            files_of_project,
            data=data_of_run,
            tables=multiext(f"results/{SCALE}/", "R.csv", "claims.json", "claims.md"),
            figures=drawn(catalogue.figures_of("paper")),
            more=more,
        output:
            f"results/{SCALE}/{name}.zip",
        log:
            f"logs/{SCALE}/{name}.log",
        params:
            code=code_of("results.products"),
            configuration=roughgas.config.as_text(config),
        message:
            "pack the run into {output}"
        shell:
            "roughgas crate {input.data:q} {input.tables:q} {input.figures:q} {input.more:q}"
            " --output {output:q} --configuration {params.configuration:q} > {log:q} 2>&1"
