"""``python -m thesis``."""

import sys

from snowshed.cli.main import main
from thesis.command import thesis

if __name__ == "__main__":
    sys.exit(main(command=thesis, name="python -m thesis"))
