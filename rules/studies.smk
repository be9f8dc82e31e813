# Studies: folders that hold a question beyond the paper each, found by being there.
from roughgas.show.studies import captions

STUDIES = config[roughgas.config.FOLDERS]
BROKEN = {
    name: f"roughgas: error: {InputError(*error)}"
    for name, error in config[roughgas.config.BROKEN].items()
}
OF_STUDY = "results/{scale}/{study}/"  # products, beside results/{scale}/{study}.{experiment}
STUDY_OF = {figure: name for name, about in STUDIES.items() for figure in about["figures"]}

if workflow.is_main_process:
    for line in BROKEN.values():
        logger.warning(f"{line} (left out; all else can be made)")


def study_of(wildcards):
    """What is known of the study that a rule makes something of."""
    return STUDIES[wildcards.get("study") or STUDY_OF[wildcards.drawn]]


def data_of_study_figure(wildcards):
    return reduced(scale_of(wildcards.folder), names_of_study_figure(wildcards))


def names_of_study_figure(wildcards):
    return study_of(wildcards)["figures"][wildcards.drawn]


def data_of_study(wildcards):
    return reduced(wildcards.scale, study_of(wildcards)["experiments"])


def data_of_study_claims(wildcards):
    """The reduced datasets of all experiments that the statements of a study are on."""
    about = study_of(wildcards)
    own = {one.partition(".")[2]: one for one in about["experiments"]}
    with one_line():
        rows = read_yaml(Path(about["folder"], "claims.yaml"))
    names = [own.get(one, one) for row in rows.values() for one in row["experiments"]]
    return reduced(wildcards.scale, dict.fromkeys(names))


def code_of_study_figure(wildcards):
    return code_beside(study_of(wildcards), ["*.py"], "show.gallery", "plotting")


def code_of_study_claims(wildcards):
    modules = "judging", "claims.report", "claims.statements"
    return code_beside(study_of(wildcards), ["*.py", "claims.yaml"], *modules)


def code_beside(about, patterns, *modules):
    """A hash of the files of a study that match any of these patterns, and of modules that they use."""
    found = [path for one in patterns for path in sorted(Path(about["folder"]).glob(one))]
    return " ".join([hash_of_code(*modules), *map(hash_of_file, found)])


# made from the output and therefore not recorded: results do not depend on where a study is, nor on
# what a caption says


def folder_of_study(wildcards, output):
    return study_of(wildcards)["folder"]


def caption_of_study_figure(wildcards, output):
    about = study_of(wildcards)
    return captions(about["folder"], [*about["figures"]]).get(wildcards.drawn, "")


def experiments_of_study_figure(wildcards, output):
    return described(scale_of(wildcards.folder), names_of_study_figure(wildcards))


def title_of_study(wildcards):
    return study_of(wildcards)["title"]


def labels_of_study(wildcards):
    return titled(title_of_study(wildcards))


def figures_of_study(name, kinds, scale):
    """The figures of a study: those that its figure.py draws, or else one of each experiment."""
    about = STUDIES[name]
    return drawn(about["figures"] or about["experiments"], kinds, scale)


def pictures_of_study(wildcards):
    return figures_of_study(wildcards.study, [".png"], wildcards.scale)


def claims_of_study(wildcards):
    about = study_of(wildcards)
    there = Path(about["folder"], "claims.yaml").exists()
    return [f"{OF_STUDY.format(**wildcards)}claims.md"] if there else []


def readme_of_study(wildcards):
    about = study_of(wildcards)
    return of_project(*Path(about["folder"]).glob("README.md"))


def products_of(name):
    """The input function of a study's rule: all that there is to it."""

    def products(wildcards):
        if name in BROKEN:
            sys.exit(BROKEN[name])
        folder = OF_STUDY.format(scale=SCALE, study=name)
        figures = figures_of_study(name, [".pdf", ".png"], SCALE)
        return [*figures, f"{folder}R.csv", f"{folder}page.html"]

    return products


rule study_figure:
    input:
        data=data_of_study_figure,
    output:
        "figures/{folder}{drawn}.pdf",
        report(
            "figures/{folder}{drawn}.png",
            caption="captions/figure.rst",
            category=catalogue.HEADINGS["beyond"],
            labels=labels_of_study,
        ),
    log:
        "logs/figures/{folder}{drawn}.log",
    wildcard_constraints:
        drawn=one_of(STUDY_OF),
    params:
        code=code_of_study_figure,
        shows=names_of_study_figure,
        folder=folder_of_study,
        caption=caption_of_study_figure,
        experiments=experiments_of_study_figure,
    message:
        "draw {wildcards.folder}{wildcards.drawn}"
    shell:
        "python -P -m roughgas.steps study_figure {params.folder:q} {wildcards.drawn:q} {input.data:q}"
        " --shows {params.shows:q} --output {output:q} > {log:q} 2>&1"


rule study_table:
    input:
        data=data_of_study,
    output:
        csv=f"{OF_STUDY}R.csv",
    log:
        "logs/{scale}/{study}_csv.log",
    wildcard_constraints:
        study=one_of(STUDIES),
    params:
        code=code_of("results.table"),
    message:
        "write {output.csv}"
    shell:
        "python -P -m roughgas.steps table {input.data:q} --output {output.csv:q} > {log:q} 2>&1"


rule study_claims:
    input:
        data=data_of_study_claims,
    output:
        json=f"{OF_STUDY}claims.json",
        markdown=f"{OF_STUDY}claims.md",
    log:
        "logs/{scale}/{study}_claims.log",
    wildcard_constraints:
        study=one_of(STUDIES),
    params:
        code=code_of_study_claims,
        folder=folder_of_study,
        title=title_of_study,
        experiments=lambda wildcards: study_of(wildcards)["experiments"],
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps study_claims {params.folder:q} {input.data:q} --title {params.title:q}"
        " --experiments {params.experiments:q} --json {output.json:q} --markdown {output.markdown:q}"
        " > {log:q} 2>&1"


rule study_page:
    input:
        readme_of_study,
        table=f"{OF_STUDY}R.csv",
        figures=pictures_of_study,
        claims=claims_of_study,
    output:
        report(
            f"{OF_STUDY}page.html",
            caption="captions/table.rst",
            category=catalogue.HEADINGS["beyond"],
            labels=labels_of_study,
        ),
    log:
        "logs/{scale}/{study}_page.log",
    wildcard_constraints:
        study=one_of(STUDIES),
    params:
        code=code_of("show.studies"),
        folder=folder_of_study,
        title=title_of_study,
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps study_page {params.folder:q} --title {params.title:q}"
        " --table {input.table:q} --figures {input.figures:q} --claims={input.claims:q}"
        " --output {output:q} > {log:q} 2>&1"


for name in [*STUDIES, *BROKEN]:

    rule:
        name:
            name
        input:
            products_of(name),
