"""Keeps GDAL from making network requests: a second barrier behind the checks of formats.

Every file is checked before GDAL opens it, and opened in one format. If a format still leads GDAL
to another machine, these options block it: no allowed suffix matches a remote file, and all
requests go to an impossible proxy.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

OPTIONS = {
    "CPL_VSIL_CURL_ALLOWED_EXTENSIONS": ".none",
    "GDAL_HTTP_PROXY": "none://",
    "GDAL_HTTPS_PROXY": "none://",
    "GDAL_HTTP_CONNECTTIMEOUT": "1",
    "GDAL_HTTP_TIMEOUT": "1",
    "GDAL_HTTP_MAX_RETRY": "0",
    "PROJ_NETWORK": "OFF",
}


@contextmanager
def fenced_pyogrio() -> Iterator[None]:
    """Block requests of pyogrio within the block; its options are restored afterwards."""
    pyogrio: Any = importlib.import_module("pyogrio")
    before = {name: pyogrio.get_gdal_config_option(name) for name in OPTIONS}
    pyogrio.set_gdal_config_options(OPTIONS)
    try:
        yield
    finally:
        pyogrio.set_gdal_config_options(before)


@contextmanager
def fenced_rasterio() -> Iterator[None]:
    """Block requests of rasterio within the block; its options are restored afterwards."""
    rasterio: Any = importlib.import_module("rasterio")
    with rasterio.Env(**OPTIONS):
        yield
