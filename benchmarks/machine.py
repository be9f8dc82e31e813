"""The machine that was measured, and what was measured on it."""

import datetime
import os
import platform
import subprocess
from importlib import metadata
from pathlib import Path

from roughgas.base import __version__

CACHES = Path("/sys/devices/system/cpu/cpu0/cache")
PACKAGES = ("numba", "llvmlite", "numpy")


def description() -> dict[str, str]:
    """What to know about the machine, by name, with the commit and the date."""
    from llvmlite import binding

    memory = _field("/proc/meminfo", "MemTotal")
    versions = (f"{name} {metadata.version(name)}" for name in PACKAGES)
    known = {
        "processor": _field("/proc/cpuinfo", "model name"),
        "instruction set": os.environ.get("NUMBA_CPU_NAME") or binding.get_host_cpu_name(),
        "cores": str(os.cpu_count()),
        "caches": _caches(),
        "memory": memory and f"{int(memory.split()[0]) / 2**20:.0f} GiB",
        "system": f"{platform.system()} {platform.release()}, {platform.machine()}",
        "versions": f"roughgas {__version__}, Python {platform.python_version()}, "
        + ", ".join(versions),
        "commit": _commit(),
        "date": datetime.date.today().isoformat(),
    }
    return {name: value for name, value in known.items() if value}


def _field(path: str, name: str) -> str:
    """Return the value in the first line `name : value` of a file of Linux; "" if there is none."""
    try:
        lines = Path(path).read_text(encoding="utf-8").splitlines()
    except OSError:
        return ""
    pairs = (line.partition(":") for line in lines)
    return next((value.strip() for key, _, value in pairs if key.strip() == name), "")


def _caches() -> str:
    """Return such as `L1 32K data, L2 1024K unified, L3 32768K unified`."""
    files = ("level", "size", "type")
    found = [
        [(folder / name).read_text(encoding="utf-8").strip() for name in files]
        for folder in sorted(CACHES.glob("index*"))
    ]
    data = (cache for cache in found if cache[2] != "Instruction")
    return ", ".join(f"L{level} {size} {kind.lower()}" for level, size, kind in data)


def _commit():
    """The commit that is checked out, and whether more has changed since."""
    command = ["git", "-C", str(Path(__file__).parent), "describe", "--always", "--dirty"]
    done = subprocess.run(command, capture_output=True, text=True)
    return done.stdout.strip()
