"""A study whose texts are an attack on whatever page shows them."""

ATTACK = "</script><script>window.hacked=1;alert(1)</script><img src=x onerror=alert(1)>"
"""What ends a script, runs one of its own, and is an element that runs another."""
CONFIGURATION = """\
experiments:
  steep:
    extends: vibrated
    description: "ATTACK `a <javascript:alert(1)>`_ {{ x }}"
figures: {hostile: [steep]}
"""
README = """\
# 'It' ATTACK {study} $(touch harmed)

![x](hostile.png)

.. include:: README.md

.. raw:: html

   ATTACK
"""
DRAWN = """\
from matplotlib.figure import Figure


def draw(bed):
    return Figure()
"""
NAME = "hostile"


def report_of(project):
    """The path of Snakemake's report of this study, which a project is given and makes."""
    folder = project.folder / "studies" / NAME
    folder.mkdir()
    (folder / "config.yaml").write_text(CONFIGURATION.replace("ATTACK", ATTACK))
    (folder / "README.md").write_text(README.replace("ATTACK", ATTACK))
    (folder / "figure.py").write_text(DRAWN)
    project.succeed("-j1", "--config", "scale=tiny", "--", NAME)
    project.succeed("--config", "scale=tiny", "--report", "report.html", "--", NAME)
    return project.folder / "report.html"
