"""GDAL without requests to other machines: a second fence behind readers of named formats only.

Every file is looked at before GDAL opens it, and opened as one format. Should a format still lead
GDAL to another machine, these options let nothing out: no file of another machine has an ending
that is allowed, and all requests go to a proxy that cannot be.
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
    """Let pyogrio make no request within the block; its options are afterwards as before."""
    pyogrio: Any = importlib.import_module("pyogrio")
    before = {name: pyogrio.get_gdal_config_option(name) for name in OPTIONS}
    pyogrio.set_gdal_config_options(OPTIONS)
    try:
        yield
    finally:
        pyogrio.set_gdal_config_options(before)


@contextmanager
def fenced_rasterio() -> Iterator[None]:
    """Let rasterio make no request within the block; its options are afterwards as before."""
    rasterio: Any = importlib.import_module("rasterio")
    with rasterio.Env(**OPTIONS):
        yield
