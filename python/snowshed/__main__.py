"""``python -m snowshed``."""

import sys

from snowshed.cli import main

if __name__ == "__main__":
    sys.exit(main())
