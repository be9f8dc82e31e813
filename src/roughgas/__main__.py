"""`python -m roughgas` is the command `roughgas`."""

import sys

from roughgas.cli import main

sys.exit(main())
