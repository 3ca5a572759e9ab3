"""The worker's process: reads a trial a line and writes a record a line, as JSON."""

from __future__ import annotations

import json
import sys
import traceback
from typing import Any

from validation.stress.solve import solve


def main() -> None:
    """Answer trials until the input ends."""
    for line in sys.stdin:
        trial: dict[str, Any] = json.loads(line)
        try:
            record = solve(trial["point"], trial["steps"])
        except Exception:
            # Whatever it is, it belongs into the table of the suite.
            record = {"ended": "raised", "message": traceback.format_exc(limit=-3)}
        sys.stdout.write(json.dumps(record) + "\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
