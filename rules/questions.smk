# Questions with runs of their own: each is a few independent tasks, a dataset that combines them, a figure, and a table.
from roughgas import studies

TASK = "results/{scale}/studies/{study}/{task}.nc"


def settings_of_study(wildcards):
    """The settings of a study and of the experiments, as JSON."""
    with one_line(TASK.format(**wildcards)):
        found = roughgas.config.study(config, wildcards.study, wildcards.scale)
        known = studies.study(wildcards.study).tasks(found["study"])
        if wildcards.task not in known:
            raise not_one_of("task", wildcards.task, known)
    return roughgas.config.as_text(found)


def tasks_of_figure(wildcards):
    """The files of all tasks of the studies that a figure shows."""
    return [
        TASK.format(scale=wildcards.scale, study=name, task=task)
        for name in entry_of(wildcards).shows
        for task in tasks_of_study(name, wildcards.scale)
    ]


def tasks_of_study(name, scale):
    """The names of a study's tasks, the longest first."""
    with one_line(f"results/{scale}/studies/{name}"):
        settings = roughgas.config.study(config, name, scale)["study"]
        return studies.study(name).tasks(settings)


def urgency_of_task(wildcards):
    names = tasks_of_study(wildcards.study, wildcards.scale)
    return len(names) - names.index(wildcards.task) if wildcards.task in names else 0


def code_of_study(wildcards):
    code = hash_of_code(f"studies.runs.{wildcards.study}", alone=["studies.files"])
    return with_files(code, settings_of_study(wildcards))


def code_of_combining(wildcards):
    return hash_of_code("studies.files", *(f"studies.{name}" for name in entry_of(wildcards).shows))


def code_of_question_figure(wildcards):
    return hash_of_code(f"studies.figures.{wildcards.study_figure}")


def study_of_figure(wildcards):
    dataset = DATASETS[wildcards.study_figure]
    return f"results/{scale_of(wildcards.folder)}/{dataset}.nc"


rule task:
    output:
        TASK,
    log:
        "logs/{scale}/studies/{study}/{task}.log",
    benchmark:
        "logs/{scale}/studies/{study}/{task}.tsv"
    priority: urgency_of_task
    params:
        code=code_of_study,
        settings=settings_of_study,
    message:
        "study {wildcards.study}: {wildcards.task}"
    shell:
        "python -P -m roughgas.steps study {wildcards.study:q} {wildcards.task:q} --scale {wildcards.scale:q}"
        " --settings {params.settings:q} --output {output:q} > {log:q} 2>&1"


rule combined_tasks:
    input:
        tasks=tasks_of_figure,
    output:
        "results/{scale}/{study_figure}.nc",
    log:
        "logs/{scale}/{study_figure}.log",
    params:
        code=code_of_combining,
    message:
        "combine the studies of {wildcards.study_figure}"
    shell:
        "python -P -m roughgas.steps combine {input.tasks:q} --output {output:q} > {log:q} 2>&1"


rule question_figure:
    input:
        data=study_of_figure,
    output:
        "figures/{folder}{study_figure}.pdf",
        report(
            "figures/{folder}{study_figure}.png",
            caption="captions/study.rst",
            category=heading_of,
            labels=labels_of,
        ),
    log:
        "logs/figures/{folder}{study_figure}.log",
    params:
        code=code_of_question_figure,
        caption=caption_of_figure,
        studies=studies_of_figure,
    message:
        "draw {wildcards.folder}{wildcards.study_figure}"
    shell:
        "python -P -m roughgas.steps figure {wildcards.study_figure:q} {input.data:q}"
        " --output {output:q} > {log:q} 2>&1"


rule question_table:
    input:
        data="results/{scale}/{study_figure}.nc",
    output:
        "results/{scale}/{study_figure}.md",
    log:
        "logs/{scale}/{study_figure}_table.log",
    params:
        code=code_of("studies.tables"),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps study_tables {input.data:q} --output {output:q} > {log:q} 2>&1"
