"""Description of the machine: processor, memory, versions, and commit."""

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
    """Return the known properties of the machine by name, with versions, commit and date."""
    from llvmlite import binding

    memory = _field("/proc/meminfo", "MemTotal")
    versions = (f"{name} {metadata.version(name)}" for name in PACKAGES)
    properties = {
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
    return {name: value for name, value in properties.items() if value}


def _field(path: str, name: str) -> str:
    """Return the value in the first line `name : value` of a file of Linux; "" if there is none."""
    try:
        lines = Path(path).read_text(encoding="utf-8").splitlines()
    except OSError:
        return ""
    pairs = (line.partition(":") for line in lines)
    return next((value.strip() for key, _, value in pairs if key.strip() == name), "")


def _caches() -> str:
    """Return the data caches, such as `L1 32K data, L2 1024K unified, L3 32768K unified`."""
    fields = ("level", "size", "type")
    caches = [
        [(folder / name).read_text(encoding="utf-8").strip() for name in fields]
        for folder in sorted(CACHES.glob("index*"))
    ]
    data = (cache for cache in caches if cache[2] != "Instruction")
    return ", ".join(f"L{level} {size} {cache_type.lower()}" for level, size, cache_type in data)


def _commit():
    """Return the present commit, with `-dirty` if there are uncommitted changes."""
    command = ["git", "-C", str(Path(__file__).parent), "describe", "--always", "--dirty"]
    process = subprocess.run(command, capture_output=True, text=True)
    return process.stdout.strip()
