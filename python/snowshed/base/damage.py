"""Errors that NumPy raises when it reads a damaged archive of arrays."""

import tokenize
import zipfile
import zlib

#: Raised by zipfile, zlib, NumPy's header reader, and code that parses the contents.
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
