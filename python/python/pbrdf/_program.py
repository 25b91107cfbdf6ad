"""The command `pbrdf-explorer` that comes with the package."""

import signal
import sys

from . import _pbrdf


def main() -> int:
    """Runs the program: its window, or a command."""
    # The program has handlers of its own; without one Ctrl-C ends it, as it does any program.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _pbrdf.main(["pbrdf-explorer", *sys.argv[1:]])
