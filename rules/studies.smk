# Studies: folders that hold a question beyond the paper each, found by being there. What no sweep of an
# experiment answers has tasks of its own, independent jobs, and a dataset that combines them.
from roughgas.config import study_folders
from roughgas.show.pages import captions

STUDIES = config[roughgas.config.FOLDERS]
BROKEN = {
    name: f"roughgas: error: {InputError(*error)}"
    for name, error in config[roughgas.config.BROKEN].items()
}
OF_STUDY = "results/{scale}/{study}/"  # products, beside results/{scale}/{study}.{experiment}
TASK_OF_STUDY = f"{OF_STUDY}tasks/{{task}}.nc"
WITH_TASKS = [name for name, about in STUDIES.items() if "tasks" in about]
WITH_MOVIE = [name for name in WITH_TASKS if Path(STUDIES[name]["folder"], "movie.py").exists()]
WITH_SLIDES = [
    name for name, about in STUDIES.items() if Path(about["folder"], "slides.py").exists()
]
SWEPT_IN_STUDIES = [one for about in STUDIES.values() for one in about["experiments"]]
OF_SLIDES = ("base.html", "document.css", "slides.html", "slides.css", "slides.js")
STUDY_OF = {figure: name for name, about in STUDIES.items() for figure in about["figures"]}

if workflow.is_main_process:
    for line in BROKEN.values():
        logger.warning(f"{line} (left out; all else can be made)")


def study_of(wildcards):
    """What is known of the study that a rule makes something of."""
    return STUDIES[wildcards.get("study") or STUDY_OF[wildcards.drawn]]


def datasets_of(study, scale, names):
    """The reduced datasets of experiments; `tasks` stands for what the tasks of a study have found."""
    found = [OF_STUDY.format(scale=scale, study=study) + "data.nc"] if "tasks" in names else []
    return reduced(scale, [one for one in names if one != "tasks"]) + found


def data_of_study_figure(wildcards):
    study = STUDY_OF[wildcards.drawn]
    return datasets_of(study, scale_of(wildcards.folder), names_of_study_figure(wildcards))


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
    return datasets_of(wildcards.study, wildcards.scale, dict.fromkeys(names))


def code_of_study_figure(wildcards):
    return code_beside(study_of(wildcards), ["*.py", "*.csv"], "show.gallery", "plotting")


def code_of_study_slides(wildcards):
    return code_beside(study_of(wildcards), ["*.py", "*.csv"], "show.slides", "plotting")


def code_of_study_claims(wildcards):
    modules = "judging", "claims"
    return code_beside(study_of(wildcards), ["*.py", "*.csv", "claims.yaml"], *modules)


def option_of_experiments(wildcards):
    names = study_of(wildcards)["experiments"]
    return ["--experiments", *names] if names else []


def code_beside(about, patterns, *modules):
    """A hash of the files of a study that match any of these patterns, and of modules that they use."""
    found = [path for one in patterns for path in sorted(Path(about["folder"]).glob(one))]
    return " ".join([hash_of_code(*modules), *map(hash_of_file, found)])


@functools.cache
def tasks_of_study_folder(name, scale):
    """The names of a study's tasks, the longest first."""
    from roughgas.tasks.running import names  # loads xarray

    settings = study_folders.tasks(config, name, scale)["study"]
    return names(STUDIES[name]["folder"], settings)


def settings_of_study_task(wildcards):
    """The settings of a study's tasks and of the experiments that they may run, as JSON."""
    with one_line(TASK_OF_STUDY.format(**wildcards)):
        known = tasks_of_study_folder(wildcards.study, wildcards.scale)
        if wildcards.task not in known:
            raise not_one_of("task", wildcards.task, known)
        found = study_folders.tasks(config, wildcards.study, wildcards.scale)
    return roughgas.config.as_text(found)


def code_of_study_task(wildcards):
    with one_line():
        code = code_in(study_of(wildcards)["folder"], "tasks", alone=["tasks.running"])
    return with_files(code, settings_of_study_task(wildcards))


def code_of_study_data(wildcards):
    folder = Path(study_of(wildcards)["folder"])
    beside = [path.name for path in folder.glob("variables.yaml")]
    with one_line():
        return code_in(folder, "results", beside, alone=["tasks.running"])


def urgency_of_study_task(wildcards):
    with one_line():
        names = tasks_of_study_folder(wildcards.study, wildcards.scale)
    return len(names) - names.index(wildcards.task) if wildcards.task in names else 0


def tasks_of_study_data(wildcards):
    with one_line():
        names = tasks_of_study_folder(wildcards.study, wildcards.scale)
    return [TASK_OF_STUDY.format(**wildcards, task=task) for task in names]


# made from the output and therefore not recorded: results do not depend on where a study is, nor on
# what a caption says


def folder_of_study(wildcards, output):
    return study_of(wildcards)["folder"]


def caption_of_study_figure(wildcards, output):
    about = study_of(wildcards)
    return captions(about["folder"], [*about["figures"]]).get(wildcards.drawn, "")


def experiments_of_study_figure(wildcards, output):
    names = [one for one in names_of_study_figure(wildcards) if one != "tasks"]
    return described(scale_of(wildcards.folder), names)


def tasks_of_study_figure(wildcards, output):
    """The settings of tasks by the study, for the caption of a figure that shows what these found."""
    if "tasks" not in names_of_study_figure(wildcards):
        return {}
    scale, name = scale_of(wildcards.folder), STUDY_OF[wildcards.drawn]
    return {name: study_folders.tasks(config, name, scale)["study"]}


def title_of_study(wildcards):
    return study_of(wildcards)["title"]


def labels_of_study(wildcards):
    return titled(title_of_study(wildcards))


def figures_of_study(name, kinds, scale):
    """The figures of a study: those that its figure.py draws, or else one of each experiment."""
    about = STUDIES[name]
    return drawn(about["figures"] or about["experiments"], kinds, scale)


def tables_of_study(name, scale):
    """The tables of a study by what they are of: R of its experiments, and what its tasks found."""
    folder, about = OF_STUDY.format(scale=scale, study=name), STUDIES[name]
    tables = {"table": [f"{folder}R.csv"]} if about["experiments"] else {}
    return tables | ({"found": [f"{folder}data.md"]} if "tasks" in about else {})


def inputs_of_study_page(wildcards):
    return tables_of_study(wildcards.study, wildcards.scale)


def options_of_study_page(wildcards, input):
    return [f"--{key}={input[key]}" for key in ("table", "found", "claims") if input.get(key)]


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
        figures = figures_of_study(name, [".pdf", ".png"], SCALE)
        if name in WITH_MOVIE:
            figures += drawn([name], [".mp4"])
        if name in WITH_SLIDES:
            figures += drawn([name], [".html"])
        tables = [path for paths in tables_of_study(name, SCALE).values() for path in paths]
        return [*figures, *tables, f"{OF_STUDY.format(scale=SCALE, study=name)}page.html"]

    return products


def products_of_each(wildcards):
    """All that there is to all studies, but for those whose code cannot be read."""
    found = []
    for name in STUDIES:
        try:
            if name in WITH_TASKS:
                tasks_of_study_folder(name, SCALE)
                code_in(STUDIES[name]["folder"], "results")
            found += products_of(name)(wildcards)
        except InputError as error:
            logger.warning(f"roughgas: error: {error} (left out; all else can be made)")
    return found


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
        studies=tasks_of_study_figure,
    message:
        "draw {wildcards.folder}{wildcards.drawn}"
    shell:
        "python -P -m roughgas.steps study_figure {params.folder:q} {wildcards.drawn:q} {input.data:q}"
        " --shows {params.shows:q} --output {output:q} > {log:q} 2>&1"


rule study_movie:
    # of what tasks have found, which its movie.py draws
    input:
        data=lambda wildcards: OF_STUDY.format(
            scale=scale_of(wildcards.folder), study=wildcards.study
        )
        + "data.nc",
    output:
        "figures/{folder}{study}.mp4",
    log:
        "logs/figures/{folder}{study}_movie.log",
    wildcard_constraints:
        study=one_of(WITH_MOVIE),
    params:
        code=code_of_study_figure,
        folder=folder_of_study,
    message:
        "draw the movie {output}"
    shell:
        "python -P -m roughgas.steps study_movie {params.folder:q} {input.data:q} --output {output:q}"
        " > {log:q} 2>&1"


rule study_slides:
    # a page with a slider through the pictures that its slides.py draws
    input:
        of_project(*(f"{PACKAGE}/show/page/{name}" for name in OF_SLIDES)),
        data=lambda wildcards: reduced(
            scale_of(wildcards.folder), study_of(wildcards)["experiments"]
        ),
    output:
        "figures/{folder}{study}.html",
    log:
        "logs/figures/{folder}{study}_slides.log",
    wildcard_constraints:
        study=one_of(WITH_SLIDES),
    params:
        code=code_of_study_slides,
        folder=folder_of_study,
        title=title_of_study,
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps study_slides {params.folder:q} {input.data:q} --title {params.title:q}"
        " --output {output:q} > {log:q} 2>&1"


rule study_task:
    # what a task that is killed leaves beside its output is no output, which Snakemake would delete
    output:
        TASK_OF_STUDY,
    log:
        "logs/{scale}/{study}/tasks/{task}.log",
    benchmark:
        "logs/{scale}/{study}/tasks/{task}.tsv"
    wildcard_constraints:
        study=one_of(WITH_TASKS),
    priority: urgency_of_study_task
    params:
        code=code_of_study_task,
        settings=settings_of_study_task,
        folder=folder_of_study,
    message:
        "study {wildcards.study}: {wildcards.task}"
    shell:
        "python -P -m roughgas.steps study_task {params.folder:q} {wildcards.task:q} --scale {wildcards.scale:q}"
        " --settings {params.settings:q} --output {output:q} > {log:q} 2>&1"


rule study_data:
    input:
        tasks=tasks_of_study_data,
    output:
        data=f"{OF_STUDY}data.nc",
        table=f"{OF_STUDY}data.md",
    log:
        "logs/{scale}/{study}_data.log",
    wildcard_constraints:
        study=one_of(WITH_TASKS),
    params:
        code=code_of_study_data,
        folder=folder_of_study,
    message:
        "combine the tasks of {wildcards.study}"
    shell:
        "python -P -m roughgas.steps study_data {params.folder:q} {input.tasks:q} --output {output.data:q}"
        " --table {output.table:q} > {log:q} 2>&1"


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
        code=code_of("results.products"),
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
        experiments=option_of_experiments,
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps study_claims {params.folder:q} {input.data:q} --title {params.title:q}"
        " {params.experiments:q} --json {output.json:q} --markdown {output.markdown:q}"
        " > {log:q} 2>&1"


rule study_page:
    input:
        readme_of_study,
        unpack(inputs_of_study_page),
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
        code=code_of("show.pages"),
        folder=folder_of_study,
        title=title_of_study,
        options=options_of_study_page,
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps study_page {params.folder:q} --title {params.title:q}"
        " --figures {input.figures:q} {params.options:q} --output {output:q} > {log:q} 2>&1"


for name in [*STUDIES, *BROKEN]:

    rule:
        name:
            name
        input:
            products_of(name),
