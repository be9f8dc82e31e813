# Products of a study: the paper, or any other folder of studies/. All studies have the same rules.
# The tables of a study are in results/{scale}/{study_folder}, where `study_folder` is NAME/, or empty
# for the paper. For questions that a sweep cannot answer, a study has tasks, which are independent jobs,
# and a dataset that combines them.


rule task:
    # the checkpoint of a killed task is not an output, which Snakemake would delete
    output:
        TASK,
    log:
        "logs/{scale}/{task_folder}/{task}.log",
    benchmark:
        "logs/{scale}/{task_folder}/{task}.tsv"
    priority: from_wildcards(tasks.priority)
    params:
        code=from_wildcards(tasks.code),
        settings=from_wildcards(tasks.settings),
        folder=unrecorded(tasks.folder),
        module=unrecorded(tasks.module),
        studies=unrecorded(tasks.study_options),
    message:
        "study {wildcards.task_folder}: {wildcards.task}"
    shell:
        "python -P -m roughgas.steps task {params.folder:q} {wildcards.task:q} {params.module:q}"
        " --scale {wildcards.scale:q} --settings {params.settings:q} {params.studies:q} --output {output:q}"
        " > {log:q} 2>&1"


rule combine:
    input:
        tasks=from_wildcards(tasks.to_combine),
    output:
        data=COMBINED,
        table="results/{scale}/{combined}.md",
    log:
        "logs/{scale}/{combined}.log",
    params:
        code=from_wildcards(tasks.combined_code),
        folder=unrecorded(tasks.combined_folder),
        modules=unrecorded(tasks.combined_modules),
    message:
        "combine the tasks of {wildcards.combined}"
    shell:
        "python -P -m roughgas.steps combine {params.folder:q} {input.tasks:q} {params.modules:q}"
        " --output {output.data:q} --table {output.table:q} > {log:q} 2>&1"


rule figure:
    # in figures/ at the scale `paper`, in a subfolder at other scales
    input:
        data=from_wildcards(drawings.data),
    output:
        "figures/{folder}{figure}.pdf",
        report(
            "figures/{folder}{figure}.png",
            caption="captions/figure.rst",
            category=from_wildcards(drawings.heading),
            labels=from_wildcards(drawings.label),
        ),
    log:
        "logs/figures/{folder}{figure}.log",
    priority: from_wildcards(drawings.priority)
    params:
        code=from_wildcards(drawings.code),
        shows=from_wildcards(drawings.shows),
        folder=unrecorded(drawings.study_folder),
        caption=unrecorded(drawings.caption),
        experiments=unrecorded(drawings.experiments),
        studies=unrecorded(drawings.tasks),
    message:
        "draw {wildcards.folder}{wildcards.figure}"
    shell:
        "python -P -m roughgas.steps figure {params.folder:q} {wildcards.figure:q} {input.data:q}"
        " --shows {params.shows:q} --output {output:q} > {log:q} 2>&1"


rule picture_for_talks:
    input:
        data=from_wildcards(drawings.talk_data),
    output:
        multiext("results/{scale}/pictures/{figure}", ".svg", ".pdf"),
    log:
        "logs/{scale}/pictures/{figure}.log",
    params:
        code=from_wildcards(drawings.code),
        shows=from_wildcards(drawings.shows),
        folder=unrecorded(drawings.study_folder),
    message:
        "draw {output}"
    shell:
        "python -P -m roughgas.steps figure {params.folder:q} {wildcards.figure:q} {input.data:q} --slide"
        " --shows {params.shows:q} --output {output:q} > {log:q} 2>&1"


rule plot:
    # any experiment of config.yaml by its name, as `roughgas plot` draws it
    input:
        data=from_wildcards(drawings.plot_data),
    output:
        multiext("figures/{folder}{plotted}", ".pdf", ".png"),
    log:
        "logs/figures/{folder}{plotted}.log",
    params:
        code=from_wildcards(drawings.plot_code),
        theory=unrecorded(drawings.plot_theory),
    message:
        "draw {wildcards.folder}{wildcards.plotted}"
    shell:
        "roughgas plot {input.data:q} {params.theory:q} --output {output:q} > {log:q} 2>&1"


rule movie:
    # in figures/movies/ at the scale `paper`, in figures/{scale}/movies/ at other scales;
    # a fresh clone has only the GIFs, and remakes them with the MP4 files
    output:
        multiext("figures/{folder}movies/{movie}", ".gif", ".mp4"),
    log:
        "logs/figures/{folder}movies/{movie}.log",
    benchmark:
        "logs/figures/{folder}movies/{movie}.tsv"
    params:
        code=from_wildcards(drawings.movie_code),
        settings=from_wildcards(drawings.movie_settings),
        options=from_wildcards(drawings.movie_options),
        studies=unrecorded(drawings.movie_studies),
    message:
        "show {wildcards.folder}{wildcards.movie} as it moves"
    shell:
        "roughgas movie {params.options:q} --fps=20 --settings {params.settings:q} {params.studies:q}"
        " --output {output:q} > {log:q} 2>&1"


rule study_movie:
    # of the data of tasks, by the study's movie.py
    input:
        data=from_wildcards(drawings.study_movie_data),
    output:
        "figures/{folder}{study}.mp4",
    log:
        "logs/figures/{folder}{study}_movie.log",
    wildcard_constraints:
        study=alternatives(studies.with_movie),
    params:
        code=from_wildcards(drawings.drawing_code),
        folder=unrecorded(studies.folder),
    message:
        "draw the movie {output}"
    shell:
        "python -P -m roughgas.steps study_movie {params.folder:q} {input.data:q} --output {output:q}"
        " > {log:q} 2>&1"


rule study_slides:
    # a page with a slider through the pictures of the study's slides.py
    input:
        of_pages("page/base.html", "page/document.css", "page/slides.html"),
        of_pages("page/theme.css", "page/slides.css", "page/slides.js"),
        data=from_wildcards(drawings.slides_data),
    output:
        "figures/{folder}{study}.html",
    log:
        "logs/figures/{folder}{study}_slides.log",
    wildcard_constraints:
        study=alternatives(studies.with_slides),
    params:
        code=from_wildcards(drawings.slides_code),
        folder=unrecorded(studies.folder),
        title=from_wildcards(studies.title),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps study_slides {params.folder:q} {input.data:q} --title={params.title:q}"
        " --output {output:q} > {log:q} 2>&1"


rule table:
    input:
        data=from_wildcards(studies.table_data),
    output:
        report(
            "results/{scale}/{study_folder}R.csv",
            caption="captions/table.rst",
            category=from_wildcards(studies.heading_of_tables),
            labels=from_wildcards(studies.table_label),
        ),
    log:
        "logs/{scale}/{study_folder}R_csv.log",
    params:
        code=code_of("results.tables"),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps table {input.data:q} --output {output:q} > {log:q} 2>&1"


rule claims:
    input:
        data=from_wildcards(studies.claims_data),
    output:
        json="results/{scale}/{study_folder}claims.json",
        markdown="results/{scale}/{study_folder}claims.md",
    log:
        "logs/{scale}/{study_folder}claims.log",
    params:
        code=from_wildcards(studies.claims_code),
        folder=unrecorded(studies.folder_of_tables),
        title=from_wildcards(studies.title_of_tables),
        experiments=from_wildcards(studies.claims_experiments),
        reservation=from_wildcards(studies.reservation),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps claims {params.folder:q} {input.data:q} --title={params.title:q}"
        " {params.experiments:q} --json {output.json:q} --markdown {output.markdown:q}"
        " --reservation={params.reservation:q}"
        " > {log:q} 2>&1"


rule study_evidence:
    # published numbers compared with ours
    input:
        data=from_wildcards(studies.evidence_data),
    output:
        "results/{scale}/{study_folder}evidence.csv",
    log:
        "logs/{scale}/{study_folder}evidence.log",
    wildcard_constraints:
        study_folder=alternatives(f"{name}/" for name in studies.with_evidence),
    params:
        code=from_wildcards(studies.evidence_code),
        shows=from_wildcards(studies.evidence_shows),
        folder=unrecorded(studies.folder_of_tables),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps study_evidence {params.folder:q} {input.data:q}"
        " --shows {params.shows:q} --output {output:q} > {log:q} 2>&1"


rule long_table:
    # of simulations that take hours, committed beside the code of its study
    input:
        data=from_wildcards(studies.long_data),
    output:
        "{long_folder}/long.csv",
    log:
        "logs/{long_folder}/long.log",
    wildcard_constraints:
        long_folder=alternatives(studies.long_folders),
    params:
        code=from_wildcards(studies.long_code),
        shows=from_wildcards(studies.long_shows),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps long_table {wildcards.long_folder:q} {input.data:q}"
        " --shows {params.shows:q} --output {output:q} > {log:q} 2>&1"


rule study_page:
    input:
        of_pages("page/base.html", "page/study.html", "page/verdicts.html"),
        of_pages("page/theme.css", "page/document.css", "page/verdicts.css", "page/verdicts.js"),
        lambda wildcards: of_project(*studies.readme(wildcards.study_folder)),
        unpack(from_wildcards(studies.page_tables)),
        figures=from_wildcards(studies.page_figures),
        claims=from_wildcards(studies.page_claims),
    output:
        report(
            "results/{scale}/{study_folder}page.html",
            caption="captions/table.rst",
            category=from_wildcards(studies.heading_of_tables),
            labels=from_wildcards(studies.page_label),
        ),
    log:
        "logs/{scale}/{study_folder}page.log",
    params:
        code=code_of("show.report"),
        shows=from_wildcards(studies.page_shows),
        folder=unrecorded(studies.folder_of_tables),
        title=from_wildcards(studies.title_of_tables),
        options=lambda wildcards, input: studies.page_options(input),
        reservation=from_wildcards(studies.reservation_of_readme),
    message:
        "write {output}"
    shell:
        "python -P -m roughgas.steps study_page {params.folder:q} --title={params.title:q}"
        " --figures {input.figures:q} --shows {params.shows:q} {params.options:q} --reservation={params.reservation:q}"
        " --output {output:q} > {log:q} 2>&1"


for name in [*studies.named, *studies.refused]:

    rule:
        name:
            name
        input:
            from_wildcards(studies.products, study=name),
