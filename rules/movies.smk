# One short movie a scene, for README and docs: its name, its experiment or variant, and what else
# `roughgas movie` is told. Studies have their own in their config.yaml.
MOVIES = {
    "vibrated": ("vibrated", "--r=0.9 --beta=0.5 --length=4 --frames=80"),
    "roughness": ("vibrated", "--r=0.9 --beta -1 0 1 --length=3 --frames=48"),
    "sheared": ("sheared", "--r=0.9 --beta=0.5 --frames=75"),
    "cooling": ("cooling", "--r=0.9 --beta=0.5 --length=8 --frames=80"),
    "rough_walls": ("vibrated_rough_walls", "--r=0.9 --beta=-1 --length=4 --frames=80"),
}
MOVIES |= {
    movie: (experiment, " ".join(options))
    for about in STUDIES.values()
    for movie, (experiment, *options) in about["movies"].items()
}


def settings_of_movie(wildcards):
    """All in config.yaml that a movie depends on, as JSON."""
    with one_line():
        if wildcards.movie not in MOVIES:
            raise InputError("movie", wildcards.movie, f"be one of {', '.join(MOVIES)}")
    found = settings(scale_of(wildcards.folder), MOVIES[wildcards.movie][0])
    return roughgas.config.as_text(roughgas.config.point_settings(found))


def told_of_movie(wildcards):
    experiment, options = MOVIES[wildcards.movie]
    return [experiment, *options.split()]


rule movie:
    # at the scale `paper` into figures/movies/, at others into a folder below figures/{scale}/;
    # a fresh clone has the GIFs, and makes them anew since it lacks the others
    output:
        "figures/{folder}movies/{movie}.gif",
        "figures/{folder}movies/{movie}.mp4",
    log:
        "logs/figures/{folder}movies/{movie}.log",
    benchmark:
        "logs/figures/{folder}movies/{movie}.tsv"
    params:
        code=code_of("show.movies", alone=["cli.products"], settings=settings_of_movie),
        settings=settings_of_movie,
        told=told_of_movie,
    message:
        "show {wildcards.folder}{wildcards.movie} as it moves"
    shell:
        "roughgas movie {params.told:q} --fps=20 --settings {params.settings:q} --checked"
        " --output {output:q} > {log:q} 2>&1"
