"""Where results come from: the environment, the commit, and whoever ran the code."""

import os
import platform
import subprocess
import sys
from importlib import metadata
from pathlib import Path
from typing import Any

from roughgas.data.opening import SCHEMA_VERSION


def environment() -> dict[str, Any]:
    """Return Python, the machine, and the version of every package that is installed."""
    packages = {one.metadata["Name"]: one.version for one in metadata.distributions()}
    return {
        "roughgas_schema_version": SCHEMA_VERSION,
        "python": sys.version,
        "platform": platform.platform(),
        "machine": platform.machine(),
        "packages": dict(sorted(packages.items(), key=lambda item: item[0].lower())),
    }


def commit() -> str | None:
    """Return the commit of the checkout that this folder is, marked if there are changes.

    None if it is no checkout, though it may be inside one.
    """
    command = ["git", "describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"]
    here = os.environ | {"GIT_CEILING_DIRECTORIES": str(Path.cwd().parent)}
    try:
        found = subprocess.run(command, capture_output=True, text=True, check=True, env=here)
    except (OSError, subprocess.CalledProcessError):
        return None
    return found.stdout.strip()


def agent() -> str | None:
    """Return the name of whoever runs this: that of ROUGHGAS_AGENT, else git's `user.name`, else
    None."""
    if (name := os.environ.get("ROUGHGAS_AGENT")) is not None:
        return name.strip() or None
    try:
        found = subprocess.run(["git", "config", "user.name"], capture_output=True, text=True)
    except OSError:
        return None
    return found.stdout.strip() or None
