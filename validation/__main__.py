"""``python -m validation``."""

import sys

from snowshed.cli.main import main
from validation.framework.command import validate

if __name__ == "__main__":
    sys.exit(main(command=validate, name="python -m validation"))
