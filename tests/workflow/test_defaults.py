"""Targets of commands that name none: in the project, and in a host with it as a module."""

import os

import pytest
import snakemakes
from project import ROOT, Project, jobs_by_rule
from slow_cases import slow_but

MODULE = """
module roughgas:
    snakefile: "{}"
    config: {{"scale": "tiny"}}


use rule * from roughgas as gases_*
"""
RULE = """
rule of_the_host:
    output:
        touch("a.txt"),
"""
FILES = ("Snakefile", "workflow/Snakefile")
HOSTS = {
    "before": (RULE + MODULE, "of_the_host"),
    "after": (MODULE + RULE, "of_the_host"),
    "without": (MODULE, "gases_figures"),
}


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    return Project(tmp_path_factory.mktemp("source"))


def planned(source, folder, *arguments):
    status, output = snakemakes.run(folder, source.environment(), ("-n", *arguments))
    assert status == 0, output
    return jobs_by_rule(output)


@pytest.mark.slow
def test_the_file_of_the_workflow_catalogue_makes_the_figures(source, tmp_path):
    snakefile = source.folder / "workflow/Snakefile"
    jobs = planned(source, tmp_path, "-s", snakefile, "--config", "scale=tiny")
    assert jobs["figure"] == 4 and jobs["by_default"] == 1


@pytest.mark.parametrize("file", slow_but(FILES[:1], FILES))
@pytest.mark.parametrize(
    "host",
    ["after", *(pytest.param(name, marks=pytest.mark.slow) for name in ("before", "without"))],
)
def test_a_host_keeps_its_default_and_has_the_figures_without_one(source, tmp_path, host, file):
    text, default = HOSTS[host]
    (tmp_path / "Snakefile").write_text(text.format(source.folder / file))
    jobs = planned(source, tmp_path)
    assert jobs[default] == 1
    assert ("gases_figure" in jobs) == (default == "gases_figures")


@pytest.mark.slow
def test_targets_of_a_checkout_are_planned_from_another_folder(source, tmp_path):
    """The page of results and the article, whose sources are beside the Snakefile."""
    snakefile = ROOT / "Snakefile"
    targets = ("numbers", "article", "evidence", "extensions")
    options = ("-s", snakefile, "--config", "scale=small", "--", *targets)
    environment = os.environ | {"PYTHONPATH": str(ROOT / "src")}
    status, output = snakemakes.run(tmp_path, environment, ("-n", *options))
    assert status == 0, output
    jobs = jobs_by_rule(output)
    assert jobs["article_pdf"] == 1 and jobs["quoted_numbers"] == 1


@pytest.mark.slow
def test_a_report_is_written_from_another_folder(source, tmp_path):
    """With the style sheet of the profile, which is in the project's folder."""
    target = "results/tiny/config.html"
    common = ("-s", source.folder / "Snakefile", "--config", "scale=tiny")
    for arguments in (
        ("-j1", *common, "--", target),
        (*common, "--report", "a.html", "--", target),
    ):
        status, output = snakemakes.run(tmp_path, source.environment(), arguments)
        assert status == 0, output
    assert "Configuration" in (tmp_path / "a.html").read_text()
