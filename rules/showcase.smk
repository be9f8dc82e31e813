# The showcase of scale: a cooling gas of many particles, filmed until it forms clusters.
FILM = "results/{scale}/showcase/clustering.nc"


def settings_of_showcase(wildcards):
    """The settings of the showcase at a scale, checked, as JSON."""
    with one_line(FILM.format(**wildcards)):
        found = roughgas.config.showcase(config, wildcards.scale)
    with one_line(f"config.yaml: showcase at scale {wildcards.scale}"):
        from roughgas.scene import check

        check(found)
    return roughgas.config.as_text(found)


def film_of_figure(wildcards):
    return FILM.format(scale=scale_of(wildcards.folder))


rule gas_of_film:
    # It leaves checkpoints beside its output. They are no output: Snakemake would delete them where
    # a job fails, while from the last one the same command goes on after a kill.
    output:
        FILM,
    log:
        "logs/{scale}/showcase/clustering.log",
    benchmark:
        "logs/{scale}/showcase/clustering.tsv"
    priority: 5
    params:
        code=code_of(
            "simulation.clustering",
            "data.film",
            settings=settings_of_showcase,
        ),
        settings=settings_of_showcase,
    message:
        "film a cooling gas; how far it is: {log}"
    shell:
        "python -P -m roughgas.steps clustering --scale {wildcards.scale:q} --settings {params.settings:q} --checked"
        " --output {output:q} > {log:q} 2>&1"


rule film:
    input:
        data=film_of_figure,
    output:
        multiext("figures/{folder}clustering", ".pdf", ".mp4"),
        report(
            "figures/{folder}clustering.png",
            caption="captions/clustering.rst",
            category=catalogue.HEADINGS["large_gas"],
            labels=titled(catalogue.FIGURES["clustering"].title),
        ),
    log:
        "logs/figures/{folder}clustering.log",
    params:
        code=code_of("show.figures.clustering"),
        showcase=showcase_of_figure,
    message:
        "draw the picture and the movie of the cooling gas"
    shell:
        "python -P -m roughgas.steps film {input.data:q} --output {output:q} > {log:q} 2>&1"
