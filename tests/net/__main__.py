"""`python -m tests.net record FOLDER` or `compare FOLDER`, in the checkout to be tested."""

import os
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]

if __name__ == "__main__":
    # package and tests of this checkout, instead of installed ones, in child processes too
    PATHS = [str(ROOT / "src"), str(ROOT), str(ROOT / "tests")]
    sys.path[:0] = PATHS
    os.environ |= {"PYTHONPATH": os.pathsep.join(PATHS[:1]), "MPLBACKEND": "agg"}
    os.environ["OPENBLAS_NUM_THREADS"] = "1"  # threads change the last bits of sums

    from tests.net.command import main

    raise SystemExit(main())
