# The workflow at a glance: config.yaml says what is simulated, rules/ how, roughgas does the work.
#
#   snakemake -j2 figures                       the four figures of the paper, a table, its claims
#   snakemake -j2 figures --config scale=small  the same in a minute, with wide error bars
#   snakemake -j2 extensions                    beyond the paper: spheres, friction, other drives ...
#   snakemake -j1 explore                       a page in which to look at every point
#   snakemake -j2 movies                        the scenes as they move, one GIF each
#   snakemake -j1 showcase                      a large cooling gas forms clusters: a movie
#   snakemake -j2 accuracy                      what the next digit costs, in CPU seconds
#   snakemake -j2 coverage                      whether error bars hold the truth as often as they say
#   snakemake -j2 hard_cases                    where simulations go wrong, and how far from it we are
#   snakemake -j2 crate                         the run as one file: an RO-Crate with checksums
#   snakemake -j1 results/paper/cooling/r0.87/beta-0.33/seed7.nc     any one point


include: "rules/common.smk"
include: "rules/sources.smk"
include: "rules/cluster.smk"


become_own_task()


include: "rules/messages.smk"


be_brief()

if workflow.is_main_process:
    alive = forget_dead_locks()  # held until this process ends

CHANGES = {key: change for key, change in config.items() if key != "scale"}  # the command line's
config = checked_config("config.yaml", config)
SCALE = config["scale"]


wildcard_constraints:
    scale="[^/]+",
    experiment=EXPERIMENT + VARIANT,
    r="[^/]+",
    beta="[^/]+",
    seed="[^/]+",
    folder="([^/]+/)?",
    figure=r"(?!clustering\.|hard_cases|accuracy\.|coverage\.)[^/]+",  # these have their own rules
    movie="[^/]+",
    study="[^/]+",
    task="[^/]+",
    study_figure="accuracy|coverage",
    family="[^/]+",


include: "rules/report.smk"
include: "rules/compile.smk"
include: "rules/simulate.smk"
include: "rules/planning.smk"
include: "rules/reduce.smk"
include: "rules/figures.smk"
include: "rules/extensions.smk"
include: "rules/showcase.smk"
include: "rules/movies.smk"
include: "rules/hard_cases.smk"
include: "rules/accuracy.smk"
include: "rules/page.smk"
include: "rules/crate.smk"


report: "rules/captions/workflow.rst"


# on a cluster, these take less than sending them there
localrules:
    figure,
    table,
    claims,
    document,
    effective_config,
    run_times,


rule figures:
    default_target: True
    input:
        drawn(catalogue.figures_of("paper")),
        f"results/{SCALE}/R.csv",
        f"results/{SCALE}/claims.json",
        f"results/{SCALE}/claims.md",
        documents("claims", "run_times", "config"),


rule everything:
    input:
        rules.figures.input,
        rules.extensions.input,
        reduced(SCALE, config["experiments"]),
        rules.showcase.input,
        rules.movies.input,
        rules.hard_cases.input,
        rules.accuracy.input,
        rules.coverage.input,
        rules.explore.input,
        rules.explore_extensions.input,


onstart:
    refuse_limit_of_jobs()
    lift_rate_limit()


onerror:
    say_how_to_go_on()
