"""Synthetic weather of stations, written as GHCN-daily by station and as SMET."""

import math
from datetime import timedelta

STATION = "USC00999999"


def days(first, last):
    """Yield the days from the first to the last."""
    for number in range((last - first).days + 1):
        yield first + timedelta(number)


def warmth(day, south=False):
    """Return a temperature for a day of the year, degrees C: -6 in January, 22 in July."""
    wave = math.cos(2.0 * math.pi * (day.timetuple().tm_yday - 15) / 365.25)
    return 8.0 - 14.0 * (-wave if south else wave)


def snows(day):
    """Return whether it snows on a day: every sixth day from December to March."""
    return day.month in (12, 1, 2, 3) and day.toordinal() % 6 == 0


def ghcn(file, rows):
    """Write days with their elements, in the units of GHCN-daily; None leaves an element out."""
    with file.open("w") as text:
        for day, elements in rows:
            for name, value in elements.items():
                if value is not None:
                    text.write(f"{STATION},{day:%Y%m%d},{name},{round(value)},,,7,1800\n")
    return file


def elements(day, snow=120.0, warm=None, **others):
    """Return the elements of a day: temperatures, and new snow (mm) if it snows."""
    mean = 10.0 * (warmth(day) if warm is None else warm)
    new = None if snow is None else snow if snows(day) else 0.0
    return {"TMAX": mean + 40.0, "TMIN": mean - 40.0, "SNOW": new, **others}


def smet(file, rows, fields, latitude=46.0):
    """Write times with the values of some fields; None: missing."""
    head = (
        "SMET 1.1 ASCII\n[HEADER]\nstation_id = X1\n"
        f"latitude = {latitude}\nlongitude = 8\naltitude = 2000\nnodata = -999\ntz = 1\n"
        f"fields = timestamp {fields}\n[DATA]\n"
    )
    lines = [" ".join([f"{time:%Y-%m-%dT%H:%M}", *map(_cell, values)]) for time, values in rows]
    file.write_text(head + "\n".join(lines) + "\n")
    return file


def _cell(value):
    return "-999" if value is None else f"{value:.3f}"
