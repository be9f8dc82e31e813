"""The project as it is in this folder, committed into a repository elsewhere."""

import shutil
import subprocess
from pathlib import Path

ROOT = Path(__file__).parent.parent
AUTHOR = ("-c", "user.name=tests", "-c", "user.email=tests@localhost")


def git(folder, *arguments):
    """Return the output of git in a folder."""
    command = ["git", *AUTHOR, *arguments]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
    return done.stdout


def commit_project(folder):
    """Make a repository in `folder`, with the branch main, of all files of the project that git
    does not ignore, except the figures."""
    names = git(ROOT, "ls-files", "-z", "--cached", "--others", "--exclude-standard").split("\0")
    for name in filter(None, names):
        if (ROOT / name).is_file() and not name.startswith("figures/"):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, folder / name, follow_symlinks=False)
    git(folder, "init", "--quiet", "--initial-branch=main")
    git(folder, "add", "--all")
    git(folder, "commit", "--quiet", "--message", "The project")
    return folder
