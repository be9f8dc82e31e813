"""What a person sees of a run: the logger plugin, on a terminal and in a pipe."""

import logging
from types import SimpleNamespace

import pytest
from snakemake.logging import DefaultFormatter
from snakemake_interface_logger_plugins.common import LogEvent
from snakemake_interface_logger_plugins.registry import LoggerPluginRegistry

from snakemake_logger_plugin_roughgas import POINTS, Brief, LogHandler

FAILED = {
    "rule_name": "point",
    "msg": "",
    "rule_msg": None,
    "jobid": 1,
    "input": [],
    "output": ["seed1.nc"],
    "log": [],
    "conda_env": None,
    "shellcmd": "roughgas run --settings LONG",
    "aux": {},
}


class Terminal:
    """A stream that takes itself for a terminal, or for a pipe."""

    def __init__(self, is_terminal):
        self.isatty, self.text = (lambda: is_terminal), ""

    def write(self, text):
        self.text += text

    def flush(self):
        pass


def test_a_failed_job_still_repeats_its_command_with_all_settings():
    """Why there is `Brief`: fails on the day that it is no longer needed. That it works is in
    tests/habits/test_stopping.py."""
    assert "--settings LONG" in DefaultFormatter().format_job_error(FAILED)
    assert Brief().format_job_error(FAILED) == "Failed: seed1.nc\n"


def test_snakemake_finds_the_plugin():
    assert LoggerPluginRegistry().is_installed("roughgas")


@pytest.fixture
def told(monkeypatch):
    """A function that has a run told: two jobs of two points each, one of which fails."""
    monkeypatch.setitem(POINTS, "block", 2)

    def run(is_terminal, verbose=False, dryrun=False):
        stream = Terminal(is_terminal)
        monkeypatch.setattr("sys.stderr", stream)
        quiet = dict.fromkeys(("nocolor", "stdout", "debug_dag", "printshellcmds"), False)
        settings = SimpleNamespace(
            **quiet, quiet=set(), verbose=verbose, dryrun=dryrun, show_failed_logs=False
        )
        handler = LogHandler(settings, None)
        job = {"rule_name": "block", "indent": False, "reason": "it is missing"}
        every = [
            ("Building DAG of jobs...", {}),
            ("Job stats: 3", {"event": LogEvent.RUN_INFO, "stats": {"block": 2, "total": 3}}),
            *(
                ("", job | {"event": LogEvent.JOB_INFO, "jobid": k, "rule_msg": f"gas {k}"})
                for k in (1, 2)
            ),
            ("Finished", {"event": LogEvent.JOB_FINISHED, "job_id": 2}),
            ("", FAILED | {"event": LogEvent.JOB_ERROR}),
            ("Complete log(s): all.log", {}),
        ]
        for text, extra in every:
            record = logging.LogRecord("snakemake", logging.INFO, "", 0, text, None, None)
            for name, value in extra.items():
                setattr(record, name, value)
            handler.emit(record)
        handler.close()
        return stream.text

    return run


def test_a_terminal_has_one_bar(told):
    said = told(is_terminal=True)
    assert "gas 2 and 1 more" in said and "2 of 4 points" in said
    assert "Failed: seed1.nc" in said and "2 points in 0 s. Every step of the run: all.log" in said
    assert "Building" not in said and "Job stats" not in said


@pytest.mark.parametrize(
    "how", [{"is_terminal": False}, {"is_terminal": True, "verbose": True}], ids=["pipe", "verbose"]
)
def test_elsewhere_and_verbosely_every_step_is_told(told, how):
    said = told(**how)
    for text in ("Building DAG", "Job stats: 3", "Job 1: gas 1", "Complete log(s): all.log"):
        assert text in said
    assert ("--settings LONG" in said) == how.get("verbose", False) and "points" not in said
