"""The logic of the workflow's rules, without Snakemake: files, settings, code, priorities.

`paths` has the paths of files, `sweeps` the points and kernels of experiments, `studies`, `figures`
and `products` the files made from them, `tasks` the tasks of studies, `fingerprints` the code of
each result, `jobs` blocks of points, run times and memory. `wildcards` passes the wildcards of a
rule to a method. Only `internals` uses parts of Snakemake outside its public interface.

In this room a point is one combination (experiment, r, beta, seed), a sweep all points of an
experiment, a block the points of one job; a scale is a named set of changes to sizes and lengths,
such as "paper"; a kernel is the compiled code of a simulation; a fingerprint is a text that changes
with code. All files are paths relative to the workflow's folder.
"""

from roughgas.base.files import PACKAGE
from roughgas.config.packaged import shipped_path

INSTALLED = PACKAGE / "pipeline" / "Snakefile"
"""Path of the workflow's Snakefile in an installed package."""
SNAKEFILE = str(INSTALLED if INSTALLED.exists() else shipped_path("Snakefile"))
"""Path of the workflow's Snakefile, installed or of a clone, for a `module` of another one."""
