"""The types of JSON data."""

from __future__ import annotations

from typing import Dict, List, Union

#: A result of `json.loads`.
JsonValue = Union[None, bool, int, float, str, List["JsonValue"], Dict[str, "JsonValue"]]
JsonObject = Dict[str, JsonValue]
