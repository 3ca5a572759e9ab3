"""Records of computations (`snowshed.results.computed_record`), which differ in their date only."""

import json

RECORDS = ("tiny.json", "season.json", "clearance.json")


def undated(content: bytes) -> dict[str, object]:
    """Return a record without its date, and without the checksum that covers the date."""
    record = json.loads(content)
    assert {"date", "checksum"} <= record.keys()
    return {key: value for key, value in record.items() if key not in ("date", "checksum")}
