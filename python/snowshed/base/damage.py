"""Errors that NumPy raises when it reads a damaged archive of arrays."""

import tokenize
import zipfile
import zlib

#: By zipfile, zlib, NumPy's reader of headers, and whoever takes the contents for what they were.
DAMAGED = (
    ValueError,
    TypeError,
    LookupError,
    AttributeError,
    EOFError,
    MemoryError,
    RuntimeError,
    OverflowError,
    SyntaxError,
    tokenize.TokenError,
    zipfile.BadZipFile,
    zipfile.LargeZipFile,
    zlib.error,
)
