# From an experiment's settings to its points, where their lengths are set (where a target is set
# instead: planning.smk). Of a point in the sweep, `seeds_per_job` seeds are made
# by one job (see config.yaml); any other seed is a job of its own.
import re

RUN = (
    "roughgas run {wildcards.experiment} --scale {wildcards.scale} --r={wildcards.r}"
    " --beta={wildcards.beta} --seed {params.seeds} --settings {params.settings:q}"
    " --checked --output {output} > {log} 2>&1"
)


def settings_of_points(wildcards):
    """All in config.yaml that the points of an experiment depend on, whichever they are, as JSON:
    what else changes there does not touch them."""
    found = settings(wildcards.scale, wildcards.experiment)
    return roughgas.config.as_text(roughgas.config.point_settings(found))


def seeds_of_job(wildcards, output):
    """The seeds of a job's outputs. Snakemake does not record params that are made from outputs: a
    point is up to date whichever job has made it."""
    return " ".join(Path(file).stem.removeprefix("seed") for file in output)


def urgency(wildcards):
    """Longest points first, lest one of them is left alone on one core at the end."""
    from roughgas.point import effort

    experiment = settings(wildcards.scale, wildcards.experiment)
    return effort(experiment, float(wildcards.r), float(wildcards.beta))


def one_of(labels):
    """The wildcard constraint for one of these labels."""
    return "|".join(re.escape(str(label)) for label in labels)


rule point:
    input:
        kernel_of_point,
    output:
        POINT,
    log:
        "logs/{scale}/{experiment}/r{r}/beta{beta}/seed{seed}.log",
    benchmark:
        "logs/{scale}/{experiment}/r{r}/beta{beta}/seed{seed}.tsv"
    priority: urgency
    params:
        settings=settings_of_points,
        seeds=seeds_of_job,
    message:
        "{wildcards.experiment}: r = {wildcards.r}, beta = {wildcards.beta}, seed = {wildcards.seed}"
    shell:
        RUN


for experiment in config["experiments"]:
    found = roughgas.config.experiment(config, experiment, SCALE)
    axes = found["sweep"]
    for seeds in roughgas.config.seed_blocks(axes.get("seeds", 0), config):
        together = f"{experiment}_seeds_{seeds[0]}_to_{seeds[-1]}"

        rule:
            name:
                together
            input:
                kernel_of_point,
            output:
                [POINT.replace("{seed}", seed) for seed in seeds],
            log:
                f"logs/{{scale}}/{{experiment}}/r{{r}}/beta{{beta}}/seeds{seeds[0]}-{seeds[-1]}.log",
            benchmark:
                f"logs/{{scale}}/{{experiment}}/r{{r}}/beta{{beta}}/seeds{seeds[0]}-{seeds[-1]}.tsv"
            wildcard_constraints:
                scale=SCALE,
                experiment=one_of(roughgas.config.variants(experiment, found)),
                r=one_of(axes["r"]),
                beta=one_of(axes["beta"]),
            priority: urgency
            params:
                settings=settings_of_points,
                seeds=seeds_of_job,
            message:
                "{wildcards.experiment}: r = {wildcards.r}, beta = {wildcards.beta},"
                " seeds {params.seeds}"
            shell:
                RUN

        # as `ruleorder` does, which takes no variables
        workflow.ruleorder(together, "point")
