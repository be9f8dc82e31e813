# What is made of reduced datasets, both for the paper and beyond it: figures, tables, verdicts, pages.
PARTS = {  # product -> the part of the catalogue of figures whose experiments it shows
    "R": "paper",
    "claims": "paper",
    "run_times": "paper",
    "explore": "paper",
    "extensions": "beyond",
    "run_times_extensions": "beyond",
    "explore_extensions": "beyond",
}


OF_EXPLORE = ("base.html", "explore.html", "explore.css", "explore.js", "plots.js", "picture.js")
OF_LIVING = ("page/base.html", "living/page.html", "living/page.css")


def data_of_figure(wildcards):
    return reduced(scale_of(wildcards.folder), entry_of(wildcards).shows)


def data_of_numbers(wildcards):
    """The reduced datasets of the paper, and of what the page of results quotes of studies."""
    from roughgas.claims.numbers import quoted  # loads xarray

    page = Path("docs/results.md").read_text(encoding="utf-8")
    named = {name.rpartition(".")[0] for name in quoted(page)}
    beyond = sorted(named & {*SWEPT_IN_STUDIES})
    return reduced(wildcards.scale, [*catalogue.shown_in("paper"), *beyond])


def data_of_plot(wildcards):
    """The reduced dataset of the experiment by whose name a figure is asked for."""
    with one_line():
        if wildcards.plotted not in config["experiments"]:
            known = {*catalogue.FIGURES, *STUDY_OF, *config["experiments"]}
            raise nearest("figure", wildcards.plotted, "a figure or an experiment", known)
    return reduced(scale_of(wildcards.folder), [wildcards.plotted])


def data_of_talk(wildcards):
    return reduced(wildcards.scale, entry_of(wildcards).shows)


def experiments_of_product(wildcards):
    part = PARTS[wildcards.product]
    return SWEPT_IN_STUDIES if part == "beyond" else catalogue.shown_in(part)


def data_of_product(wildcards):
    return reduced(wildcards.scale, experiments_of_product(wildcards))


def points_of_product(wildcards):
    every = (points(wildcards.scale, name) for name in experiments_of_product(wildcards))
    return [point for some in every for point in some]


def descriptions_of_product(wildcards):
    names = experiments_of_product(wildcards)
    return [settings(wildcards.scale, name).get("description") for name in names]


def heading_of_product(wildcards):
    return catalogue.HEADINGS[PARTS[wildcards.product]]


def name_of_config(wildcards, output):
    """Made from the output and therefore not recorded: results do not depend on where it is."""
    return of_project(CONFIG)


def folder_of_points(wildcards, output):
    """That of the page, too; in a module with a prefix it lies below that."""
    return Path(output[0]).parent


rule figure:
    # at the scale `paper` into figures/, at others into a folder below it
    input:
        data=data_of_figure,
    output:
        "figures/{folder}{figure}.pdf",
        report(
            "figures/{folder}{figure}.png",
            caption="captions/figure.rst",
            category=heading_of,
            labels=labels_of,
        ),
    log:
        "logs/figures/{folder}{figure}.log",
    priority: FIRST
    params:
        code=code_of("show.figures.paper", "show.style"),
        caption=caption_of_figure,
        experiments=experiments_of_figure,
    message:
        "draw {wildcards.folder}{wildcards.figure}"
    shell:
        "python -P -m roughgas.steps figure {wildcards.figure:q} {input.data:q}"
        " --output {output:q} > {log:q} 2>&1"


rule plot:
    # any experiment of config.yaml by its name, as `roughgas plot` draws it
    input:
        data=data_of_plot,
    output:
        multiext("figures/{folder}{plotted}", ".pdf", ".png"),
    log:
        "logs/figures/{folder}{plotted}.log",
    params:
        code=code_of("show.figures.sweep", "show.style"),
    message:
        "draw {wildcards.folder}{wildcards.plotted}"
    shell:
        "roughgas plot {input.data:q} --output {output:q} > {log:q} 2>&1"


rule picture_for_talks:
    input:
        data=data_of_talk,
    output:
        "results/{scale}/pictures/{figure}.svg",
        "results/{scale}/pictures/{figure}.pdf",
    log:
        "logs/{scale}/pictures/{figure}.log",
    params:
        code=code_of("show.figures.paper", "show.style"),
    message:
        "draw {output}"
    shell:
        "python -P -m roughgas.steps figure {wildcards.figure:q} {input.data:q} --slide"
        " --output {output:q} > {log:q} 2>&1"


rule table:
    input:
        data=data_of_product,
    output:
        report(
            "results/{scale}/{product}.csv",
            caption="captions/table.rst",
            category=heading_of_product,
            labels=titled("Table: every number (CSV, to download)"),
        ),
    log:
        "logs/{scale}/{product}_csv.log",
    wildcard_constraints:
        product="R|extensions",
    params:
        code=code_of("results.products"),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps table {input.data:q} --output {output:q} > {log:q} 2>&1"


rule claims:
    input:
        data=data_of_product,
    output:
        json="results/{scale}/{product}.json",
        markdown="results/{scale}/{product}.md",
    log:
        "logs/{scale}/{product}.log",
    wildcard_constraints:
        product="claims",
    params:
        code=code_of("claims"),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps claims {input:q} --json {output.json:q}"
        " --markdown {output.markdown:q} > {log:q} 2>&1"


rule quoted_numbers:
    # what docs/results.md and the article quote
    input:
        data=data_of_numbers,
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
    # beside the figures, where the documentation finds it in a clone that has no results
    input:
        lambda wildcards: f"results/{scale_of(wildcards.folder)}/{wildcards.file}",
    output:
        "figures/{folder}{file}",
    log:
        "logs/figures/{folder}{file}.log",
    wildcard_constraints:
        file=one_of(["evidence.csv", "numbers.json"]),
    message:
        "write {output}"
    shell:
        "cp {input:q} {output:q} 2> {log:q}"


rule run_times:
    input:
        data=data_of_product,
    output:
        "results/{scale}/{product}.md",
    log:
        "logs/{scale}/{product}.log",
    wildcard_constraints:
        product="run_times|run_times_extensions",
    params:
        code=code_of("results.products"),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps run_times {input.data:q} --output {output:q} > {log:q} 2>&1"


rule page:
    input:
        of_project(*(f"{PACKAGE}/show/page/{name}" for name in OF_EXPLORE)),
        points_of_product,
        data=data_of_product,
    output:
        "results/{scale}/{product}.html",
    log:
        "logs/{scale}/{product}.log",
    wildcard_constraints:
        product="explore|explore_extensions",
    params:
        code=code_of("show.explore"),
        descriptions=descriptions_of_product,
        config=name_of_config,
        points=folder_of_points,
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps explore {input.data:q} --points {params.points:q} --config {params.config:q}"
        " --output {output:q} > {log:q} 2>&1"


rule living_page:
    # at any scale: its gas is as large as the page can show
    input:
        of_project(*(f"{PACKAGE}/show/{name}" for name in OF_LIVING)),
        of_project(*sorted(Path(PACKAGE, "show/living").glob("*.js"))),
        config=of_project(CONFIG),
    output:
        "results/{scale}/living.html",
    log:
        "logs/{scale}/living.log",
    params:
        code=code_of("show.living"),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps living --config {input.config:q} --output {output:q} > {log:q} 2>&1"
