# What `snakemake --report` shows, and under which headings. Captions are in captions/: those of rules
# with many products include the text of the product, and add the parameters of this run.


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


def heading_of_figure(wildcards):
    return catalogue.FIGURES[wildcards.figure].heading


def labels_of_figure(wildcards):
    return titled(catalogue.FIGURES[wildcards.figure].title)


def labels_of_study(wildcards):
    return titled(catalogue.FIGURES[wildcards.study_figure].title)


def heading_of_document(wildcards):
    return catalogue.DOCUMENTS[wildcards.document].heading


def labels_of_document(wildcards):
    return titled(catalogue.DOCUMENTS[wildcards.document].title)


def source_of_document(wildcards):
    shown = catalogue.DOCUMENTS[wildcards.document].source
    folder = "" if wildcards.scale == "paper" else f"{wildcards.scale}/"
    return shown.format(scale=wildcards.scale, folder=folder)


def caption_of_document(wildcards, output):
    """Not recorded, as the settings below: a new caption is no reason to write the page anew."""
    return catalogue.DOCUMENTS[wildcards.document].caption


def experiments_of_figure(wildcards, output):
    """The settings of the experiments that a figure shows, for its caption: not recorded, as those of
    `seeds_of_job`, here and below. A description that changes is no reason to draw anew."""
    scale = wildcards.folder.rstrip("/") or "paper"
    return {name: settings(scale, name) for name in catalogue.FIGURES[wildcards.figure].shows}


def studies_of_figure(wildcards, output):
    """The settings of the studies that a figure shows, for its caption."""
    scale = wildcards.folder.rstrip("/") or "paper"
    with one_line(f"figures/{wildcards.folder}{wildcards.study_figure}"):
        return {
            name: roughgas.config.study(config, name, scale)["study"]
            for name in catalogue.FIGURES[wildcards.study_figure].shows
        }


def showcase_of_figure(wildcards, output):
    """The settings of the showcase, for its caption."""
    with one_line(f"figures/{wildcards.folder}clustering"):
        return roughgas.config.showcase(config, wildcards.folder.rstrip("/") or "paper")


def documents(*names):
    """The documents of these names at the scale of this run."""
    return [f"results/{SCALE}/{name}.html" for name in names]
