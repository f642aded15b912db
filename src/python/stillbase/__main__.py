"""The command line: `python -m stillbase check spot` is `stillbase check spot`."""

import signal
import sys

from ._stillbase import main

if __name__ == "__main__":
    # The command ends at once, as the program does.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(main(["stillbase", *sys.argv[1:]]))
