"""What the rules patch in Snakemake. A test fails on the day that a patch is no longer needed, or
that it no longer works: see then whether an option will do."""

import inspect

from snakemake.logging import DefaultFormatter
from snakemake.scheduling.job_scheduler import JobScheduler

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


def test_a_failed_job_still_repeats_its_command_with_all_settings():
    """`Brief` in rules/messages.smk; that it works is in tests/habits/test_stopping.py."""
    assert "--settings LONG" in DefaultFormatter().format_job_error(FAILED)


def test_a_limit_of_jobs_still_adds_a_round_of_scheduling_to_each():
    """`lift_rate_limit` in rules/common.smk."""
    source = inspect.getsource(JobScheduler.schedule)
    assert "self._schedule_reevalutation(self.job_rate_limiter.timespan)" in source
    assert "if self.job_rate_limiter is None:" in inspect.getsource(JobScheduler.job_selector)
