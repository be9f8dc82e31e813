# From an experiment's settings to its points, where their lengths are set (where a target is set
# instead: planning.smk). Of the sweep, `seeds_per_job` seeds at `betas_per_job` values of beta are
# made by one job (see config.yaml); any other point is a job of its own.
import re

RUN = (
    "roughgas run {wildcards.experiment} --scale {wildcards.scale} --r={wildcards.r} {params.points}"
    " --settings {params.settings:q} --checked --output {output} > {log} 2>&1"
)


def settings_of_points(wildcards):
    """All in config.yaml that the points of an experiment depend on, whichever they are, as JSON:
    what else changes there does not touch them."""
    found = settings(wildcards.scale, wildcards.experiment)
    return roughgas.config.as_text(roughgas.config.point_settings(found))


def points_of_job(wildcards, output):
    """The betas and seeds of a job's outputs, each with each. Snakemake does not record params that
    are made from outputs: a point is up to date whichever job has made it."""
    files = [Path(file) for file in output]
    betas = dict.fromkeys(file.parent.name.removeprefix("beta") for file in files)
    seeds = dict.fromkeys(file.stem.removeprefix("seed") for file in files)
    return " ".join([*(f"--beta={beta}" for beta in betas), "--seed", *seeds])


def urgency(wildcards):
    """Longest points first, lest one of them is left alone on one core at the end. A job on several
    betas counts as if they were 0."""
    from roughgas.simulation.point import effort

    experiment = settings(wildcards.scale, wildcards.experiment)
    return effort(experiment, float(wildcards.r), float(wildcards.get("beta", "0")))


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
        points=points_of_job,
    message:
        "{wildcards.experiment}: r = {wildcards.r}, beta = {wildcards.beta}, seed = {wildcards.seed}"
    shell:
        RUN


for experiment in config["experiments"]:
    found = roughgas.config.experiment(config, experiment, SCALE)
    axes = found["sweep"]
    for number, (betas, seeds) in enumerate(roughgas.config.blocks(axes, config), start=1):
        together = f"{experiment}_block_{number}"
        first, last = betas[0], betas[-1]
        span = first if first == last else f"{first}to{last}"
        log_of_job = f"logs/{{scale}}/{{experiment}}/r{{r}}/beta{span}/seeds{seeds[0]}-{seeds[-1]}"

        rule:
            name:
                together
            input:
                kernel_of_point,
            output:
                [
                    POINT.replace("{beta}", beta).replace("{seed}", seed)
                    for beta in betas
                    for seed in seeds
                ],
            log:
                f"{log_of_job}.log",
            benchmark:
                f"{log_of_job}.tsv"
            wildcard_constraints:
                scale=SCALE,
                experiment=one_of(roughgas.config.variants(experiment, found)),
                r=one_of(axes["r"]),
                beta=one_of(axes["beta"]),
            priority: urgency
            params:
                settings=settings_of_points,
                points=points_of_job,
            message:
                "{wildcards.experiment}: r = {wildcards.r}, {params.points}"
            shell:
                RUN

        # as `ruleorder` does, which takes no variables
        workflow.ruleorder(together, "point")
