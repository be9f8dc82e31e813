# What `snakemake --report` shows, and under which headings. Captions are in captions/: those of rules
# with many products include the text of the product, and add the parameters of this run.
THE_PAPER, BEYOND, HARD, ACCURACY, LARGE, THIS_RUN = (
    "1 The paper",
    "2 Beyond the paper",
    "3 Hard cases",
    "4 Accuracy",
    "5 A large gas",
    "6 This run",
)
TITLES = {
    "fig1a": "Fig. 1a: a vibrated bed",
    "fig1b": "Fig. 1b: its side walls",
    "fig2a": "Fig. 2a: a sheared gas",
    "fig2b": "Fig. 2b: a freely cooling gas",
    "fig3": "Fig. 3: spheres",
    "fig4": "Fig. 4: Coulomb friction",
    "fig5": "Fig. 5: drives that put in rotation",
    "fig6": "Fig. 6: wave forms",
    "fig7": "Fig. 7: the moment of inertia",
    "fig8": "Fig. 8: what boundaries are made of",
    "hard_cases": "Every margin",
    "hard_cases_collapse": "Inelastic collapse",
    "hard_cases_chaos": "Chaos",
    "hard_cases_cooling": "Cooling very far",
    "accuracy": "What the next digit costs",
    "coverage": "Whether error bars are true",
}
DOCUMENTS = {  # name -> heading, title, and what it shows
    "claims": (THE_PAPER, "Table: the paper's claims", "results/{scale}/claims.md"),
    "open_questions": (
        BEYOND,
        "Table: what the paper leaves open",
        "results/{scale}/open_questions.md",
    ),
    "hard_cases": (HARD, "Table: all cases", "results/{folder}hard_cases.md"),
    "accuracy": (ACCURACY, "Table: what the next digit costs", "results/{scale}/accuracy.md"),
    "coverage": (ACCURACY, "Table: whether error bars are true", "results/{scale}/coverage.md"),
    "clustering": (LARGE, "Movie", "figures/{folder}clustering.mp4"),
    "run_times": (THIS_RUN, "Run times: the paper", "results/{scale}/run_times.md"),
    "run_times_extensions": (
        THIS_RUN,
        "Run times: beyond the paper",
        "results/{scale}/run_times_extensions.md",
    ),
    "config": (THIS_RUN, "Configuration", "results/{scale}/config.yaml"),
}


def titled(title):
    """The labels of a product in the report."""
    return {"product": title}


def picture(name):
    """A picture among the hard cases, for the report."""
    return report(
        f"figures/{{folder}}{name}.png",
        caption=f"captions/{name}.rst",
        category=HARD,
        labels=titled(TITLES[name]),
    )


def heading_of_figure(wildcards):
    return THE_PAPER if wildcards.figure in PAPER else BEYOND


def labels_of_figure(wildcards):
    return titled(TITLES[wildcards.figure])


def labels_of_study(wildcards):
    return titled(TITLES[wildcards.study_figure])


def heading_of_document(wildcards):
    return DOCUMENTS[wildcards.document][0]


def labels_of_document(wildcards):
    return titled(DOCUMENTS[wildcards.document][1])


def source_of_document(wildcards):
    _, _, shown = DOCUMENTS[wildcards.document]
    folder = "" if wildcards.scale == "paper" else f"{wildcards.scale}/"
    return shown.format(scale=wildcards.scale, folder=folder)


def experiments_of_figure(wildcards, output):
    """The settings of the experiments that a figure shows, for its caption: not recorded, as those of
    `seeds_of_job`, here and below. A description that changes is no reason to draw anew."""
    scale = wildcards.folder.rstrip("/") or "paper"
    return {name: settings(scale, name) for name in FIGURES[wildcards.figure]}


def studies_of_figure(wildcards, output):
    """The settings of the studies that a figure shows, for its caption."""
    scale = wildcards.folder.rstrip("/") or "paper"
    with one_line(f"figures/{wildcards.folder}{wildcards.study_figure}"):
        return {
            name: roughgas.config.study(config, name, scale)["study"]
            for name in SHOWN[wildcards.study_figure]
        }


def showcase_of_figure(wildcards, output):
    """The settings of the showcase, for its caption."""
    with one_line(f"figures/{wildcards.folder}clustering"):
        return roughgas.config.showcase(config, wildcards.folder.rstrip("/") or "paper")


def documents(*names):
    """The documents of these names at the scale of this run."""
    return [f"results/{SCALE}/{name}.html" for name in names]
