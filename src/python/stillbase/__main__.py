"""The command line: `python -m stillbase check spot` is `stillbase check spot`."""

import sys

from ._stillbase import main

if __name__ == "__main__":
    sys.exit(main(["stillbase", *sys.argv[1:]], ends_process=True))
