# The workflow at a glance: config.yaml says what is simulated, rules/ how, roughgas does the work.
#
#   snakemake -j2 figures                       the four figures of the paper, a table, its claims
#   snakemake -j2 figures --config scale=small  the same in a minute, with wide error bars
#   snakemake -j2 friction                      one question beyond the paper, of a folder of studies/
#   snakemake -j2 extensions                    all of them
#   snakemake -j2 evidence                      every published number that we know of beside ours
#   snakemake -j2 numbers                       the numbers that docs/results.md quotes
#   snakemake -j2 article                       the article on this reproduction, a PDF
#   snakemake -j1 explore                       a page in which to look at every point
#   snakemake -j1 living                        a page in which a gas moves, with sliders
#   snakemake -j1 pictures                      the four figures for talks: SVG, and PDF of 16 to 9
#   snakemake -j2 movies                        the scenes as they move, one GIF each
#   snakemake -j2 accuracy                      what the next digit costs, in CPU seconds
#   snakemake -j2 coverage                      whether error bars hold the truth as often as they say
#   snakemake -j2 hard_cases                    where simulations go wrong, and how far from it we are
#   snakemake -j2 crate                         the run as one file: an RO-Crate
#   snakemake -j2 deposit                       the same with the article, for an archive
#   snakemake -j2 fig1a                         a figure by its name, or an experiment's R over its sweep
#   snakemake -j1 results/paper/cooling/r0.87/beta-0.33/seed7.nc     any one point


include: "rules/common.smk"
include: "rules/messages.smk"


# of --sdm apptainer, which gives every rule the environment that Apptainer.def builds
container: image()


check_folders()
config = own_config(config)
CHANGES = {key: change for key, change in config.items() if key != "scale"}  # the command line's
config = checked_config(CONFIG, config)
SCALE = config["scale"]
FIGURES_OF_STUDIES = [
    figure for one in config[roughgas.config.FOLDERS].values() for figure in one["figures"]
]


wildcard_constraints:
    scale=NAME,
    # a folder of products has the name of its study
    experiment=rf"(?!(?:{one_of(config[roughgas.config.FOLDERS])})/){EXPERIMENT}{VARIANT}",
    r=NAME,
    beta=NAME,
    seed=NAME,
    folder=f"({NAME}/)?",
    figure="|".join(catalogue.figures_of("paper")),
    # other figures have their own rules
    plotted=rf"(?!(?:{one_of([*catalogue.FIGURES, *FIGURES_OF_STUDIES])})\.(?:pdf|png)$){NAME}",
    movie=NAME,
    study=NAME,
    task=NAME,
    family=NAME,


include: "rules/report.smk"
include: "rules/simulate.smk"
include: "rules/studies.smk"
include: "rules/evidence.smk"
include: "rules/products.smk"
include: "rules/accuracy.smk"
include: "rules/movies.smk"
include: "rules/hard_cases.smk"


report: "rules/captions/workflow.rst"


# on a cluster, these take less than sending them there; of modules Snakemake does not know the names
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
        drawn(catalogue.figures_of("paper")),
        multiext(f"results/{SCALE}/", "R.csv", "claims.json", "claims.md"),
        documents("claims", "run_times", "config"),


rule extensions:
    input:
        products_of_each,
        f"results/{SCALE}/extensions.csv" if SWEPT_IN_STUDIES else [],
        documents("run_times_extensions") if SWEPT_IN_STUDIES else [],


rule evidence:
    input:
        drawn(["evidence"]),
        kept("evidence.csv"),
        documents("evidence"),


rule numbers:
    input:
        kept("numbers.json"),


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
        [
            f"results/{SCALE}/pictures/{name}.{kind}"
            for name in catalogue.figures_of("paper")
            for kind in ("svg", "pdf")
        ],


rule movies:
    input:
        drawn([f"movies/{movie}" for movie in MOVIES], [".gif", ".mp4"]),


rule accuracy:
    input:
        drawn(["accuracy", "accuracy_limits"]),
        f"results/{SCALE}/accuracy.md",
        documents("accuracy"),


rule coverage:
    input:
        drawn(["coverage"]),
        f"results/{SCALE}/coverage.md",
        documents("coverage"),


rule hard_cases:
    input:
        f"results/{'' if SCALE == 'paper' else SCALE + '/'}hard_cases.md",
        documents("hard_cases"),


rule everything:
    input:
        rules.figures.input,
        rules.extensions.input,
        reduced(SCALE, [one for one in config["experiments"] if "." not in one]),
        reduced(SCALE, SWEPT_IN_STUDIES),
        rules.movies.input,
        rules.hard_cases.input,
        rules.accuracy.input,
        rules.coverage.input,
        rules.explore.input,
        rules.explore_extensions.input,
        rules.living.input,


# figures by their names, and experiments by theirs, but for names that have a rule
for name in [*catalogue.FIGURES, *STUDY_OF, *config["experiments"]]:
    if not rules.has(name):

        rule:
            name:
                name
            input:
                drawn([name]),


if not IS_MODULE:
    logger.addFilter(is_of_use)
logger.addFilter(say_what_was_meant)


onstart:
    be_alone()
    start_jobs_at_once(workflow)


onerror:
    say_how_to_go_on()
