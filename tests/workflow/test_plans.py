"""Functions behind the rules of the workflow, without Snakemake: files, settings, priorities."""

import dataclasses
import inspect
import re
from pathlib import Path
from types import SimpleNamespace

import pytest
from tests.study_modules import ROOT

from roughgas import config
from roughgas.base import InputError
from roughgas.base.files import PACKAGE
from roughgas.base.reading import read_yaml
from roughgas.workflow import internals, jobs, paths, wildcards
from roughgas.workflow.figures import Figures
from roughgas.workflow.products import Products, files_of_checkout, files_to_pack
from roughgas.workflow.studies import Studies, experiments_in_order
from roughgas.workflow.sweeps import Sweeps, points_of_job
from roughgas.workflow.tasks import Tasks


@pytest.fixture(scope="module")
def configuration():
    return config.load(ROOT / "config.yaml", {"scale": "small"})


@pytest.fixture(scope="module")
def sweeps(configuration):
    return Sweeps(configuration, experiments_in_order(configuration))


@pytest.fixture(scope="module")
def studies(configuration, sweeps):
    return Studies(configuration, sweeps)


@pytest.fixture(scope="module")
def tasks(studies):
    return Tasks(studies)


@pytest.fixture(scope="module")
def figures(studies):
    return Figures(studies)


@pytest.fixture(scope="module")
def products(studies, tasks):
    return Products(studies, tasks)


# ---------------------------------------------------------------- paths and wildcards


def test_the_folder_of_a_scale_is_that_of_its_figures():
    for scale, folder in (("paper", ""), ("small", "small/")):
        assert paths.folder_of(scale) == folder and paths.scale_of(folder) == scale
    assert paths.figure_files(["fig1a"], "small", [".png"]) == ["figures/small/fig1a.png"]


def test_labels_match_literally_and_an_empty_list_matches_nothing():
    assert re.fullmatch(paths.alternatives(["0.9", "1"]), "0.9")
    assert not re.fullmatch(paths.alternatives(["0.9"]), "0x9")
    assert not re.match(paths.alternatives([]), "")


def test_a_function_of_a_rule_takes_the_wildcards_that_it_names():
    def area(r, height=2):
        return r, height

    labels = {"r": "0.9", "seed": "3"}
    assert wildcards.from_wildcards(area)(labels) == ("0.9", 2)
    assert wildcards.unrecorded(area, height=5)(labels, ["out.nc"]) == ("0.9", 5)
    assert wildcards.per_attempt(lambda attempt: attempt)(labels, 3) == 3


def test_bad_input_of_a_rule_ends_the_workflow_with_one_line():
    def refuse(r):
        with wildcards.located("results/a.nc"):
            raise InputError("r", r, "be less")

    with pytest.raises(SystemExit, match=r"^roughgas: error: results/a.nc: r = 2: must be less$"):
        wildcards.from_wildcards(refuse)({"r": "2"})


# ---------------------------------------------------------------- points


def test_each_point_of_a_sweep_is_in_one_block_or_a_job_of_its_own(configuration, sweeps):
    blocks = list(sweeps.blocks())
    names = [block.name for block in blocks]
    assert names[-1] == "point" and len(set(names)) == len(names)
    for experiment in ("vibrated", "sheared", "friction.vibrated_friction"):
        for point in sweeps.points("small", experiment):
            makers = [block.name for block in blocks if _makes(block, point)]
            assert len(makers) == 1, (point, makers)
            assert makers[0] == "point" or makers[0].startswith(f"{experiment}_block")


def _makes(block, path):
    """Return whether a path matches the pattern of an output of a block, with its constraints."""
    for output in block.outputs:
        pattern = re.escape(output).replace(r"\{", "{").replace(r"\}", "}")
        for name in re.findall(r"{(\w+)}", pattern):
            constraint = block.constraints.get(name, paths.NAME)
            if name == "experiment":
                constraint = block.constraints.get(name, paths.EXPERIMENT + paths.VARIANT)
            pattern = pattern.replace(f"{{{name}}}", f"(?:{constraint})")
        if re.fullmatch(pattern, path):
            return True
    return False


def test_one_job_makes_a_whole_sweep_that_takes_seconds(configuration, sweeps):
    (short,) = _blocks_of("sheared", sweeps)
    paths_of_points = [path.format(scale="small", experiment="sheared") for path in short.outputs]
    assert paths_of_points == sweeps.points("small", "sheared")
    assert [values["r"] for values in short.at_each_r] == ["0.99", "0.9", "0.8", "0.6"]
    at_full_size = Sweeps(dataclasses.replace(configuration, scale="paper"), [])
    (long,) = _blocks_of("sheared", at_full_size)
    assert long.at_each_r == ({},) and all("/r{r}/" in output for output in long.outputs)


def test_the_display_counts_the_work_of_a_job_of_several_r(sweeps):
    """Its wildcards have no r: the work follows from the paths of its points."""
    (short,) = _blocks_of("sheared", sweeps)
    wildcards_of_job = {"scale": "small", "experiment": "sheared"}
    output = [path.format(**wildcards_of_job) for path in short.outputs]
    job = SimpleNamespace(jobid=7, output=output, wildcards=wildcards_of_job)
    run = internals.Run(sweeps, [job])
    collisions = [
        sweeps.collisions(**wildcards_of_job, r=r, beta=beta)
        for r, beta in (re.search(r"/r([^/]+)/beta([^/]+)/", path).groups() for path in output)
    ]
    assert len(set(collisions)) > 4  # they differ by r and beta
    overhead = len(output) * internals.POINT_OVERHEAD
    assert run._total == pytest.approx(sum(collisions) + overhead)


def _blocks_of(experiment, sweeps):
    """Return the blocks of an experiment at the scale of `sweeps`; their names are numbered."""
    return [block for block in sweeps.blocks() if block.name.startswith(f"{experiment}_block")]


def test_the_name_of_a_block_does_not_depend_on_other_experiments(configuration):
    def is_short(experiment):
        return experiment == "sheared"

    names = {block.name for block in jobs.blocks(configuration, "small", "cooling", is_short)}
    alone = config.load(
        ROOT / "config.yaml",
        {"scale": "small", "experiments": {"added": {"extends": "cooling"}}},
    )
    assert names <= {block.name for block in jobs.blocks(alone, "small", "cooling", is_short)}


def test_the_kernel_of_a_point_is_that_of_the_first_r_which_needs_the_same(sweeps):
    first = sweeps.kernel("small", "cooling", "0.99")
    assert sweeps.kernel("small", "cooling", "0.8") == first
    assert first == "results/small/cooling/r0.99/compiled.txt"


@pytest.mark.parametrize(
    ("labels", "message"),
    [
        (("cooling", "1.5", "0", "1"), "results/small/cooling: restitution r = 1.5"),
        (("heating", "0.9", "0", "1"), "results/small/heating: experiment = 'heating'"),
        (("cooling", "0.90", "0", "1"), "a number has one spelling in paths"),
        (("friction.cooling_friction", "0.9", "0", "1"), "must be followed by a variant"),
    ],
)
def test_an_illegal_point_is_refused(sweeps, labels, message):
    with pytest.raises(InputError) as refusal:
        sweeps.kernel("small", *labels)
    assert message in str(refusal.value)


def test_the_longest_jobs_start_first_and_the_quickest_figure_before_others(sweeps):
    def priority(experiment, points=1, r="0.9"):
        return sweeps.priority(points, "small", experiment, r)

    assert priority("cooling") > priority("sheared") > priority("vibrated")
    assert priority("cooling", 8) > priority("cooling", 2)
    assert sweeps.kernel_priority("cooling") > priority("cooling", 10**9)
    assert priority("drives.heated/spin_share0") < priority("vibrated")


def test_run_time_and_memory_are_estimates_times_the_attempt(sweeps):
    first, second = (sweeps.minutes(44, attempt, "paper", "vibrated", "0.9") for attempt in (1, 2))
    assert 5 <= first < 24 * 60 and second in (2 * first - 1, 2 * first)
    assert sweeps.minutes(4, 1, "paper", "vibrated", "0.9") < first
    first, third = (sweeps.megabytes(attempt, "paper", "vibrated") for attempt in (1, 3))
    assert 500 < first < 2000 and 3 * first - 3 < third <= 3 * first


def test_the_options_of_a_block_are_its_axes():
    outputs = [f"results/a/b/r1/beta{beta}/seed{n}.nc" for beta in ("-1", "0") for n in (1, 2)]
    assert points_of_job(outputs) == ["--r=1", "--beta=-1", "--beta=0", "--seed", "1", "2"]
    outputs = [f"results/a/b/c0.5/r{r}/beta0.1/seed1.nc" for r in ("1", "0.9")]
    assert points_of_job(outputs) == ["--r=1", "--r=0.9", "--beta=0.1", "--seed", "1"]


# ---------------------------------------------------------------- studies


def test_the_paper_is_a_study_whose_products_have_no_folder_of_their_own(studies, figures):
    paper = studies.by_table_folder[""]
    assert paper is studies.paper and paper.drawn == ["fig1a", "fig1b", "fig2a", "fig2b"]
    assert "results/small/claims.md" in studies.products("paper")
    assert "results/small/page.html" not in studies.products("paper")
    assert figures.data("small/", "fig2b") == ["results/small/cooling.nc"]
    assert figures.heading("fig2b") == "1 The paper" and "cooling gas" in figures.caption("fig2b")


def test_every_product_of_a_study_is_below_its_name(studies):
    for name in ("friction", "runaway"):
        files = studies.products(name)
        assert f"results/small/{name}/page.html" in files
        assert all(name in file for file in files)


def test_figures_are_drawn_from_the_data_that_their_study_names(studies, figures):
    for figure, products in studies.by_figure.items():
        for path in figures.data("small/", figure):
            assert path.startswith("results/small/") and path.endswith(".nc")
        assert figures.label(figure)["product"] and figures.heading(figure)
        assert Path(products.folder).name == products.name


def test_the_claims_of_a_study_are_on_experiments_of_its_own_or_of_the_root(studies):
    data = studies.claims_data("small", "friction/")
    assert "results/small/friction.vibrated_friction.nc" in data
    assert studies.claims_data("small", "")[0] == "results/small/vibrated.nc"
    assert studies.claims_experiments("") == []


def test_a_table_of_long_runs_is_made_of_what_the_scale_long_changes(configuration, studies):
    """In the order of its changes, by studies with long.py; without the scale there are none."""
    (folder,) = (folder for folder in studies.long_folders if folder.endswith("transport"))
    assert f"{folder}/long.csv" in studies.long_tables()
    changed = list(read_yaml(ROOT / "studies/transport/config.yaml")["scales"]["long"])
    shown = studies.long_shows(folder)
    assert [name.removeprefix("transport.") for name in shown] == changed
    assert "results/long/transport/data.nc" in studies.long_data(folder)
    assert all(path.startswith("results/long/") for path in studies.long_data(folder))
    scales = {scale: x for scale, x in configuration.scales.items() if scale != "long"}
    without = dataclasses.replace(configuration, scales=scales)
    assert not Studies(without, studies.sweeps).long_tables()


def test_tasks_are_named_and_refused_by_their_study(tasks):
    names = tasks.names("small", "runaway/tasks")
    first = tasks.priority("small", "runaway/tasks", names[0])
    assert first == len(names) > tasks.priority("small", "runaway/tasks", names[-1])
    assert len(tasks.to_combine("small", "runaway/data")) == len(names)
    with pytest.raises(InputError, match=r"^results/small/runaway/tasks/a.nc: task = a: must"):
        tasks.settings("small", "runaway/tasks", "a")


def test_a_broken_study_is_refused_and_others_are_made(tmp_path, monkeypatch):
    folder = tmp_path / "studies" / "broken"
    folder.mkdir(parents=True)
    (folder / "config.yaml").write_text("experiments: {x: {extends: vibrated, particles: -3}}")
    monkeypatch.chdir(tmp_path)
    configuration = config.load(ROOT / "config.yaml", {"scale": "small"})
    studies = Studies(configuration, Sweeps(configuration, []))
    assert "particles = -3" in studies.refused["broken"]
    with pytest.raises(InputError, match="particles = -3"):
        studies.products("broken")
    assert studies.products("friction")


def test_products_of_a_run_show_the_paper_or_all_extensions(products):
    assert products.data("small", "run_times")[0] == "results/small/vibrated.nc"
    beyond = products.data("small", "extensions")
    assert "results/small/friction.cooling_friction.nc" in beyond
    assert "results/small/vibrated.nc" not in beyond
    assert products.numbers_data("small", ROOT)[0] == "results/small/vibrated.nc"


def test_targets_that_need_a_checkout_are_refused_without_one(products, tmp_path):
    with pytest.raises(InputError, match=r"be a checkout of the project, whose docs/results\.md"):
        products.numbers_data("small", tmp_path)
    with pytest.raises(InputError, match="be a checkout of the project, whose article this is"):
        files_of_checkout(tmp_path, "article", "*.*")
    with pytest.raises(InputError, match=r"be a checkout of the project, whose pyproject\.toml"):
        files_to_pack(tmp_path)
    with pytest.raises(InputError, match="which a crate packs"):
        files_to_pack(ROOT)


# ---------------------------------------------------------------- rules


def _rules():
    text = "\n".join(file.read_text() for file in (ROOT / "rules").glob("*.smk"))
    return text + (ROOT / "Snakefile").read_text()


def test_rules_pass_all_parameters_of_their_methods(sweeps, studies, tasks, figures, products):
    """Each method that a rule names exists, and its parameters are wildcards or fixed."""
    rooms = {"sweeps": sweeps, "studies": studies, "tasks": tasks, "drawings": figures}
    rooms["run_products"] = products
    patterns = paths.POINT, paths.KERNEL, paths.TASK, paths.COMBINED
    wildcard_names = set(re.findall(r"{(\w+)}", _rules() + "".join(patterns))) | {"attempt"}
    calls = re.findall(r"(?:from_wildcards|unrecorded|per_attempt)\((\w+)\.(\w+)([^()]*)", _rules())
    methods = [call for call in calls if call[0] in rooms]
    assert len(methods) > 40
    for room, name, fixed in methods:
        parameters = inspect.signature(getattr(rooms[room], name)).parameters
        assert set(parameters) - set(re.findall(r"(\w+)=", fixed)) <= wildcard_names, (room, name)


def test_rules_define_no_functions_but_those_of_snakemake():
    """Computations are in the package, except calls of Snakemake's functions."""
    defined = re.findall(r"^def (\w+)", _rules(), re.M)
    allowed = {"image", "of_project", "of_pages", "of_checkout", "code_of", "extensions_of_run"}
    assert {*defined} <= allowed


def test_no_file_of_the_workflow_but_one_names_snakemake_internals():
    for file in (PACKAGE / "workflow").glob("*.py"):
        text = file.read_text()
        assert len(text.splitlines()) < 400
        assert ("import snakemake" in text or "from snakemake" in text) == (
            file.name == "internals.py"
        )
        if file.name != "internals.py":
            assert "needrun_jobs" not in text and "job_rate_limiter" not in text
