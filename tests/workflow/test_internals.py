"""Internals of Snakemake that the workflow uses, and its behaviour if they are missing."""

import logging
from types import SimpleNamespace

import pytest

from roughgas.workflow import internals


def record(message="", **fields):
    log_record = logging.makeLogRecord({"msg": message})
    for name, value in fields.items():
        setattr(log_record, name, value)
    return log_record


@pytest.fixture
def logger():
    return logging.getLogger("tests.internals")


def workflow(**attributes):
    settings = SimpleNamespace(verbose=False, dryrun=False)
    return SimpleNamespace(output_settings=settings, rules=[], **attributes)


def test_a_snakemake_with_other_internals_shows_its_run_itself(logger, capsys):
    """Its graph has no needrun_jobs: every record passes, after one warning."""
    from snakemake_interface_logger_plugins.common import LogEvent

    display = internals.Display(workflow(dag=SimpleNamespace()), None, logger)
    display.install()
    assert display.is_shown in logger.filters
    assert logger.filter(record(event=LogEvent.RUN_INFO))
    warning = capsys.readouterr().err
    assert warning.count("\n") == 1
    assert "this Snakemake shows its run itself (AttributeError: " in warning
    assert display.is_shown not in logger.filters
    assert logger.filter(record("Select jobs to execute"))
    assert capsys.readouterr().err == ""


def test_a_scheduler_with_other_internals_is_left_unchanged():
    scheduler = SimpleNamespace()
    local_run = SimpleNamespace(scheduler=scheduler, local_exec=True)
    internals.remove_job_rate_limit(local_run)
    internals.stop_on_sigterm(local_run)
    internals.remove_job_rate_limit(SimpleNamespace())
    assert vars(scheduler) == {}
    scheduler.job_rate_limiter = object()
    internals.remove_job_rate_limit(SimpleNamespace(scheduler=scheduler, local_exec=False))
    assert scheduler.job_rate_limiter is not None
    internals.remove_job_rate_limit(local_run)
    assert scheduler.job_rate_limiter is None


def test_only_a_host_without_a_default_gets_that_of_the_module():
    host = SimpleNamespace(default_target="all")
    internals.leave_default_to_host(host, internals.default_of(host), "gases_figures")
    assert host.default_target == "all"
    free = SimpleNamespace(default_target=None)
    internals.leave_default_to_host(free, internals.default_of(free), "gases_figures")
    assert free.default_target == "gases_figures"
    assert not free.default_target  # so that the host's first rule takes its place
    unlike = SimpleNamespace()
    internals.leave_default_to_host(unlike, internals.default_of(unlike), "gases_figures")
    assert vars(unlike) == {}


def test_a_target_that_nothing_makes_has_a_hint(logger):
    named = [SimpleNamespace(name="fig2a", has_wildcards=lambda: False)]
    workflow_with_rule = workflow()
    workflow_with_rule.rules = named
    missed = record("No rule to produce figg2a (if you use input functions")
    assert internals.Display(workflow_with_rule, None, logger).add_remedy(missed)
    assert "such as fig2a" in missed.getMessage()


def test_the_executor_is_read_if_snakemake_states_it():
    plugin = SimpleNamespace(name="slurm")
    assert internals.executor_of(SimpleNamespace(executor_plugin=plugin)) == "slurm"
    assert internals.executor_of(SimpleNamespace()) == ""
