"""`lint-imports` keeps the floors of pyproject.toml: an import that climbs breaks a contract."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
COMMAND = "import importlinter.cli, sys; sys.exit(importlinter.cli.lint_imports(no_cache=True))"
ADDED = {  # files with imports that break each contract
    "floors": {"base/added.py": "import roughgas.theory"},
    "figures and verdicts read data only": {"results/added.py": "import numba"},
    "the facade is for users": {"cli/added.py": "import roughgas.library"},
    "no circles between files": {
        "theory/added.py": "import roughgas.theory.back",
        "theory/back.py": "import roughgas.theory.added",
    },
}


@pytest.fixture
def lint_imports(tmp_path):
    """A function that returns, for a copy of the package, which contracts are kept."""
    for name in ("src", "benchmarks", "pyproject.toml"):
        copied = shutil.copytree if (ROOT / name).is_dir() else shutil.copy2
        copied(ROOT / name, tmp_path / name)

    def run():
        done = subprocess.run(
            [sys.executable, "-c", COMMAND],
            cwd=tmp_path,
            env={"PYTHONPATH": f"{tmp_path / 'src'}:{tmp_path}"},
            capture_output=True,
            text=True,
        )
        kept = {name: f"{name} KEPT" in done.stdout for name in ADDED}
        assert (done.returncode == 0) == all(kept.values()), done.stdout + done.stderr
        return kept

    return run


def test_no_import_climbs_a_floor_unnoticed(lint_imports, tmp_path):
    assert lint_imports() == dict.fromkeys(ADDED, True)
    for files in ADDED.values():
        for name, content in files.items():
            (tmp_path / "src/roughgas" / name).write_text(content)
    assert lint_imports() == dict.fromkeys(ADDED, False)
