"""The `catchment` command, as `pip install` puts it on the path."""

from __future__ import annotations

import signal
import sys

from . import _catchment


def main() -> int:
    """Does what the command line of this process says; returns the exit code."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        # The program listens to Ctrl-C itself.
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _catchment.program(["catchment", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
