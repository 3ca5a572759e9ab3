"""Accepted descriptions of coordinate systems: those that need no other file and no request.

Libraries accept more than descriptions as coordinate systems: addresses, which they fetch, and
names of files, which they open. A file from elsewhere could make them fetch or read anything.
"""

from __future__ import annotations

import re

from snowshed.base.limits import MAX_COORDINATE_SYSTEM_BYTES

#: Codes of PROJ's own data base, such as EPSG:25833 or EPSG:25833+5941.
CODE = re.compile(r"(EPSG:\d{1,9}(\+\d{1,9})?|ESRI:\d{1,9}|OGC:CRS(84|27|83)h?)", re.IGNORECASE)
#: The old form of a code in a proj string.
OLD_CODE = re.compile(r"\+init=(epsg:\d{1,9})(\s+\+(no_defs|type=crs))*", re.IGNORECASE)
WKT = re.compile(
    r"(PROJCS|PROJCRS|PROJECTEDCRS|GEOGCS|GEOGCRS|GEOGRAPHICCRS|GEODCRS|GEODETICCRS|GEOCCS|COMPD_CS"
    r"|COMPOUNDCRS|BOUNDCRS|LOCAL_CS|ENGCRS|ENGINEERINGCRS|DERIVEDPROJCRS)\s*[\[(]",
    re.IGNORECASE,
)
#: A parameter of a proj string whose value names no file.
PARAMETER = re.compile(r"\+?\w+(=[\w.,+-]*)?")
#: Parameters whose values are files; the word @null stands for none.
OF_FILES = ("init", "nadgrids", "geoidgrids", "grids", "xy_grids", "z_grids", "file")
NO_FILE = re.compile(r"\+?(nadgrids|geoidgrids)=@null", re.IGNORECASE)


def plain_system(description: str) -> str:
    """Return the description of a coordinate system if it is accepted, else "".

    Accepted are WKT, codes such as "EPSG:31287", and proj strings without names of files.

    Examples
    --------
    >>> plain_system("EPSG:31287"), plain_system("+init=epsg:31287 +no_defs")
    ('EPSG:31287', 'EPSG:31287')
    >>> plain_system("http://example.com/31287"), plain_system("+init=/tmp/file:1")
    ('', '')
    """
    text = description.strip()
    if len(text) > MAX_COORDINATE_SYSTEM_BYTES or "\0" in text:
        return ""
    if old := OLD_CODE.fullmatch(text):
        return old[1].upper()
    if CODE.fullmatch(text):
        return text
    if text.startswith("+"):
        return text if _names_no_file(text) else ""
    within = re.findall(r'"\s*(\+[^"]*)"', text)
    return text if WKT.match(text) and all(_names_no_file(part) for part in within) else ""


def _names_no_file(proj: str) -> bool:
    """Return whether no parameter of a proj string names a file."""
    return all(
        NO_FILE.fullmatch(word)
        or (
            PARAMETER.fullmatch(word) and word.lstrip("+").partition("=")[0].lower() not in OF_FILES
        )
        for word in proj.split()
    )


def first_part(wkt: str) -> str:
    """Return the horizontal system in the WKT of a compound one; other WKT unchanged.

    Examples
    --------
    >>> first_part('COMPD_CS["both",PROJCS["map",UNIT["metre",1]],VERT_CS["height"]]')
    'PROJCS["map",UNIT["metre",1]]'
    """
    if not re.match(r"\s*COMP(D_CS|OUNDCRS)\s*\[", wkt, re.IGNORECASE):
        return wkt
    depth, start, quoted = 0, None, False
    for place, character in enumerate(wkt):
        if character == '"':
            quoted = not quoted
        elif quoted:
            continue
        elif character == "," and depth == 1 and start is None:
            start = place + 1
        elif character == "[":
            depth += 1
        elif character == "]":
            depth -= 1
            if depth == 1 and start is not None:
                return wkt[start : place + 1].strip()
    return wkt
