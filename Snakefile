# The workflow at a glance: config.yaml defines the simulations, rules/ the steps, roughgas runs them.
#
#   snakemake -j2 figures                       the four figures of the paper, a table, its claims
#   snakemake -j2 figures --config scale=small  the same in a minute, with wide error bars
#   snakemake -j2 friction                      one question beyond the paper, of a folder of studies/
#   snakemake -j2 extensions                    all of them
#   snakemake -j2 papers                        papers of other groups, a few lines of configuration each
#   snakemake -j2 evidence                      every published number known to us, compared with ours
#   snakemake -j2 evidence_long                 what takes longer: tables studies/NAME/long.csv
#   snakemake -j2 numbers                       the numbers that docs/results.md quotes
#   snakemake -j2 article                       the article on this reproduction, a PDF
#   snakemake -j1 explore                       a page to inspect every point
#   snakemake -j1 living                        a page with a moving gas and sliders
#   snakemake -j1 pictures                      the four figures for talks: SVG, and PDF of 16 to 9
#   snakemake -j2 movies                        movies of the scenes, one GIF each
#   snakemake -j2 accuracy                      the cost of the next digit, in CPU seconds
#   snakemake -j2 coverage                      how often error bars hold the truth
#   snakemake -j2 hard_cases                    cases where simulations may go wrong, with their margins
#   snakemake -j2 crate                         the run as one file: an RO-Crate
#   snakemake -j2 deposit                       the same with the article, for an archive
#   snakemake -j2 fig1a                         a figure by its name, or an experiment's R over its sweep
#   snakemake -j1 results/paper/cooling/r0.87/beta-0.33/seed7.nc     any one point


include: "rules/common.smk"


# for --sdm apptainer: every rule runs in the environment that Apptainer.def builds
container: image()


wildcard_constraints:
    scale=NAME,
    # folders of products are named after studies
    experiment=rf"(?!(?:{alternatives(studies.named)})/){EXPERIMENT}{VARIANT}",
    r=NAME,
    beta=NAME,
    seed=NAME,
    folder=f"({NAME}/)?",
    study_folder=rf"(?:(?:{alternatives(studies.named)})/)?",
    figure=alternatives(studies.by_figure),
    # figures of the catalogue and of studies have other rules
    plotted=rf"(?!(?:{alternatives([*catalogue.FIGURES, *studies.by_figure])})\.(?:pdf|png)$){NAME}",
    movie=NAME,
    task_folder=alternatives(tasks.by_task_folder),
    task=NAME,
    combined=alternatives(studies.by_combined),
    family=NAME,


include: "rules/simulate.smk"
include: "rules/studies.smk"
include: "rules/products.smk"
include: "rules/hard_cases.smk"


report: "rules/captions/workflow.rst"


# too short to be sent to a cluster; in a module Snakemake does not know these names
if not IS_MODULE:

    localrules:
        figure,
        picture_for_talks,
        table,
        claims,
        document,
        effective_config,
        run_times,
        living_page,
        front,


rule figures:
    default_target: True
    input:
        from_wildcards(studies.products, study="paper"),


rule extensions:
    input:
        extensions_of_run,
        f"results/{SCALE}/extensions.csv" if run_products.beyond else [],
        paths.documents(SCALE, "run_times_extensions") if run_products.beyond else [],


rule papers:
    input:
        from_wildcards(run_products.papers, scale=SCALE),


rule evidence:
    input:
        paths.figure_files(["evidence"], SCALE),
        paths.with_copy(SCALE, "evidence.csv"),
        paths.documents(SCALE, "evidence"),


rule evidence_long:
    # tables of simulations that take hours, which `evidence` reads
    input:
        studies.long_tables(),


rule numbers:
    input:
        paths.with_copy(SCALE, "numbers.json"),


rule article:
    input:
        f"results/{SCALE}/article.pdf",


rule explore:
    input:
        f"results/{SCALE}/explore.html",


rule explore_extensions:
    input:
        f"results/{SCALE}/explore_extensions.html",


rule living:
    input:
        f"results/{SCALE}/living.html",


rule pictures:
    input:
        expand(
            f"results/{SCALE}/pictures/{{figure}}.{{suffix}}",
            figure=studies.paper.drawn,
            suffix=["svg", "pdf"],
        ),


rule movies:
    input:
        paths.figure_files(
            [f"movies/{movie}" for movie in drawings.movies], SCALE, [".gif", ".mp4"]
        ),


rule hard_cases:
    input:
        f"results/{paths.folder_of(SCALE)}hard_cases.md",
        paths.documents(SCALE, "hard_cases"),


rule everything:
    input:
        rules.figures.input,
        rules.extensions.input,
        rules.papers.input,
        from_wildcards(run_products.every_reduced),
        rules.movies.input,
        rules.hard_cases.input,
        rules.accuracy.input,
        rules.coverage.input,
        rules.explore.input,
        rules.explore_extensions.input,
        rules.living.input,


# targets named after figures and experiments, except for names that have a rule
for name in [*catalogue.FIGURES, *studies.by_figure, *CONFIGURATION.experiments]:
    if not rules.has(name):

        rule:
            name:
                name
            input:
                paths.figure_files([name], SCALE),


display = internals.Display(workflow, sweeps, logger)
logger.addFilter(display.add_remedy)
if IS_MODULE:
    internals.leave_default_to_host(workflow, DEFAULT, rules.figures.rule.name)
else:
    display.install()


onstart:
    with exit_on_bad_input():
        executors.check_executor(internals.executor_of(workflow))
    internals.lock_workdir()
    internals.remove_job_rate_limit(workflow)
    internals.stop_on_sigterm(workflow)


onerror:
    internals.print_resume_hint()
