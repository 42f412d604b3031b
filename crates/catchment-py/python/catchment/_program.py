"""The `catchment` command, which `pip install` puts on the path."""

from __future__ import annotations

import signal
import sys

from . import _catchment


def main() -> int:
    """Runs the command line of this process; returns the exit code."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        # The program handles Ctrl-C itself.
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _catchment.program(["catchment", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
