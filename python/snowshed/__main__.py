"""``python -m snowshed``."""

import sys

from snowshed.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
