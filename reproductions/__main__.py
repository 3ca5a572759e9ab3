"""``python -m reproductions``: the command ``snowshed reproduce``."""

import sys

from snowshed.cli.commands.reproduce import reproduce
from snowshed.cli.main import main

if __name__ == "__main__":
    sys.exit(main(command=reproduce, name="python -m reproductions"))
