"""``python -m snowshed``."""

import sys

from snowshed.cli.start import main

if __name__ == "__main__":
    sys.exit(main())
