# What accuracy costs, and whether error bars are true: independent tasks, datasets that combine them,
# figures and tables.
from roughgas import accuracy

OF_ACCURACY = "results/{scale}/accuracy/{study}/{task}.nc"


def settings_of_accuracy(wildcards):
    """The settings of a study and of the experiments, as JSON."""
    with one_line(OF_ACCURACY.format(**wildcards)):
        found = roughgas.config.study(config, wildcards.study, wildcards.scale)
        known = tasks_of_accuracy(wildcards.study, wildcards.scale)
        if wildcards.task not in known:
            raise not_one_of("task", wildcards.task, known)
    return roughgas.config.as_text(found)


def tasks_of_accuracy(study, scale):
    """The names of a study's tasks, the longest first."""
    with one_line(f"results/{scale}/accuracy/{study}"):
        settings = roughgas.config.accuracy(config, scale)[study]
        return accuracy.study(study).tasks(settings)


def urgency_of_accuracy(wildcards):
    names = tasks_of_accuracy(wildcards.study, wildcards.scale)
    return len(names) - names.index(wildcards.task) if wildcards.task in names else 0


def parts_of_accuracy(wildcards):
    """The files of all tasks that a dataset combines."""
    return [
        OF_ACCURACY.format(scale=wildcards.scale, study=study, task=task)
        for study in accuracy.DATASETS[wildcards.dataset]
        for task in tasks_of_accuracy(study, wildcards.scale)
    ]


def code_of_accuracy(wildcards):
    """A hash of the studies that are run, or combined in a dataset."""
    known = accuracy.DATASETS
    names = known[wildcards.dataset] if "dataset" in wildcards.keys() else [wildcards.study]
    return hash_of_code(*(f"accuracy.{name}" for name in names), alone=["accuracy.running"])


def data_of_accuracy_figure(wildcards):
    dataset = wildcards.study_figure.partition("_")[0]
    return f"results/{scale_of(wildcards.folder)}/{dataset}.nc"


def settings_of_accuracy_figure(wildcards, output):
    """The settings of the studies that a figure shows, for its caption."""
    with one_line(f"figures/{wildcards.folder}{wildcards.study_figure}"):
        every = roughgas.config.accuracy(config, scale_of(wildcards.folder))
    return {name: every[name] for name in entry_of(wildcards).shows}


rule accuracy_task:
    output:
        OF_ACCURACY,
    log:
        "logs/{scale}/accuracy/{study}/{task}.log",
    benchmark:
        "logs/{scale}/accuracy/{study}/{task}.tsv"
    wildcard_constraints:
        study=one_of(accuracy.STUDIES),
    priority: urgency_of_accuracy
    params:
        code=code_of_accuracy,
        settings=settings_of_accuracy,
    message:
        "study {wildcards.study}: {wildcards.task}"
    shell:
        "python -P -m roughgas.steps accuracy_task {wildcards.study:q} {wildcards.task:q}"
        " --scale {wildcards.scale:q} --settings {params.settings:q} --output {output:q} > {log:q} 2>&1"


rule accuracy_data:
    input:
        tasks=parts_of_accuracy,
    output:
        "results/{scale}/{dataset}.nc",
    log:
        "logs/{scale}/{dataset}.log",
    wildcard_constraints:
        dataset=one_of(accuracy.DATASETS),
    params:
        code=code_of_accuracy,
    message:
        "combine the tasks of {wildcards.dataset}"
    shell:
        "python -P -m roughgas.steps accuracy_data {input.tasks:q} --output {output:q} > {log:q} 2>&1"


rule accuracy_figure:
    input:
        data=data_of_accuracy_figure,
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
    wildcard_constraints:
        study_figure=one_of(accuracy.FIGURES),
    params:
        code=code_of("accuracy.figures", alone=["accuracy.running"]),
        caption=caption_of_figure,
        studies=settings_of_accuracy_figure,
    message:
        "draw {wildcards.folder}{wildcards.study_figure}"
    shell:
        "python -P -m roughgas.steps accuracy_figure {wildcards.study_figure:q} {input.data:q}"
        " --output {output:q} > {log:q} 2>&1"


rule accuracy_table:
    input:
        data="results/{scale}/{dataset}.nc",
    output:
        "results/{scale}/{dataset}.md",
    log:
        "logs/{scale}/{dataset}_table.log",
    wildcard_constraints:
        dataset=one_of(accuracy.DATASETS),
    params:
        code=code_of_accuracy,
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps accuracy_table {input.data:q} --output {output:q} > {log:q} 2>&1"
