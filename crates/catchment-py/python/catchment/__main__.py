"""`python -m catchment` runs the `catchment` command."""

import sys

from ._program import main

sys.exit(main())
