"""The machine that something runs on, and the versions of what runs."""

import os
import platform
from pathlib import Path

import llvmlite
import numba
import numpy

from roughgas.base.version import __version__

CACHES = Path("/sys/devices/system/cpu/cpu0/cache")


def description() -> dict[str, str]:
    """What to know about the machine, by name; what it does not tell is left out."""
    told = {
        "processor": _field("/proc/cpuinfo", "model name"),
        "instruction set": numba.config.CPU_NAME or llvmlite.binding.get_host_cpu_name(),
        "cores": str(os.cpu_count()),
        "caches": _caches(),
        "memory": _memory(),
        "system": f"{platform.system()} {platform.release()}, {platform.machine()}",
        "versions": f"roughgas {__version__}, Python {platform.python_version()}, "
        f"numba {numba.__version__}, llvmlite {llvmlite.__version__}, numpy {numpy.__version__}",
    }
    return {name: value for name, value in told.items() if value}


def _field(path, name):
    """The value in the first line `name : value` of a file of the kernel's."""
    try:
        lines = Path(path).read_text(encoding="utf-8").splitlines()
    except OSError:
        return None
    pairs = (line.partition(":") for line in lines)
    return next((value.strip() for key, _, value in pairs if key.strip() == name), None)


def _memory():
    total = _field("/proc/meminfo", "MemTotal")
    return total and f"{int(total.split()[0]) / 2**20:.0f} GiB"


def _caches():
    """Such as `L1 32K Data, L2 1024K Unified, L3 32768K Unified`."""
    levels = []
    for folder in sorted(CACHES.glob("index*")):
        level, size, kind = (
            (folder / name).read_text(encoding="utf-8").strip()
            for name in ("level", "size", "type")
        )
        if kind != "Instruction":
            levels.append(f"L{level} {size} {kind.lower()}")
    return ", ".join(levels)
