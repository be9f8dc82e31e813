# A finished run of the paper as one file to keep and to share: an RO-Crate.
from roughgas.results.crate import project_files


def data_of_run(wildcards):
    return reduced(SCALE, catalogue.shown_in("paper"))


def files_of_project(wildcards):
    """What a crate packs besides results; ends the workflow where that is in another folder."""
    with one_line():
        if SOURCE != Path():
            raise InputError("folder", os.getcwd(), f"be {SOURCE.resolve()}, which a crate packs")
    return of_project(*project_files())


rule crate:
    input:
        files_of_project,
        data=data_of_run,
        tables=multiext(f"results/{SCALE}/", "R.csv", "claims.json", "claims.md"),
        figures=drawn(catalogue.figures_of("paper")),
    output:
        f"results/{SCALE}/crate.zip",
    log:
        f"logs/{SCALE}/crate.log",
    params:
        code=code_of("results.crate"),
        configuration=roughgas.config.as_text(config),
    message:
        "pack the run into {output}"
    shell:
        "roughgas crate {input.data:q} {input.tables:q} {input.figures:q} --output {output:q}"
        " --configuration {params.configuration:q} > {log:q} 2>&1"
