"""What the rules patch in Snakemake: fails on the day that the patch is no longer needed."""

from snakemake.logging import DefaultFormatter

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
