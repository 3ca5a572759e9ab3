"""Synthetic weather files of a few rows for special cases."""

from datetime import datetime, timedelta

from helpers import weather_files

BEGIN = datetime(2024, 1, 10)


def smet(fields, rows, header="", begin=BEGIN, step=1.0):
    """Return a SMET file: `rows` are texts of cells, `step` hours apart."""
    times = (begin + timedelta(hours=step * n) for n in range(len(rows)))
    lines = (f"{time:%Y-%m-%dT%H:%M} {row}\n" for time, row in zip(times, rows))
    return (
        "SMET 1.1 ASCII\n[HEADER]\nstation_id = made\nlatitude = 46.5\nlongitude = 9.8\n"
        f"altitude = 2000\nnodata = -999\ntz = 1\n{header}fields = timestamp {fields}\n[DATA]\n"
        + "".join(lines)
    )


def meteoswiss(fields, rows, begin=BEGIN, step=1.0, name="XYZ"):
    times = (begin + timedelta(hours=step * n) for n in range(len(rows)))
    return f"station_abbr;reference_timestamp;{fields}\n" + "".join(
        f"{name};{time:%d.%m.%Y %H:%M};{row}\n" for time, row in zip(times, rows)
    )


def imis(times, temperature=-5.0, depths=None):
    return "station_code,measure_date,hyear,HS,TA_30MIN_MEAN\n" + "".join(
        f"XXX2,{time},2024,{30 if depths is None else depths[n]},{temperature}\n"
        for n, time in enumerate(times)
    )


def epw(rows, latitude=46.8):
    """Return an EPW file of (end, temperature, depth in cm, mm, hours of the mm)."""
    lines = []
    for end, warm, depth, rain, hours in rows:
        day = end - timedelta(hours=1)
        lines.append(
            f"{day.year},{day.month},{day.day},{day.hour + 1},60,?9?9,{warm},-9.8,79,84100,0,1415,"
            f"288,0,0,0,0,0,0,0,340,6.7,6,6,20.0,420,9,999999999,0,0.0500,{depth},88,0.6,{rain},"
            f"{hours}\n"
        )
    return weather_files.EPW_HEADER.replace("46.82", str(latitude)) + "".join(lines)


def tmy3(rows, latitude=46.8):
    """Return a TMY3 file of (end, temperature, mm, hours of the mm)."""
    lines = [
        f'724666,"HINTERALP/FIELD",CO,-7.0,{latitude},-105.117,1689\n',
        "Date (MM/DD/YYYY),Time (HH:MM),Dry-bulb (C),Lprecip depth (mm),Lprecip quantity (hr)\n",
    ]
    for end, warm, rain, hours in rows:
        day = end - timedelta(hours=1)
        lines.append(f"{day:%m/%d/%Y},{day.hour + 1:02d}:00,{warm},{rain},{hours}\n")
    return "".join(lines)


def hourly(begin, end):
    """Yield the ends of the hours between two times."""
    while begin < end:
        begin += timedelta(hours=1)
        yield begin


def ghcn(*rows):
    """Return a by_station file of (day of January 2024, element, value, optionally both flags)."""
    lines = []
    for day, element, value, *flags in rows:
        measurement, quality = flags or ("", "")
        date = f"202401{day:02d}"
        lines.append(f"USC00999999,{date},{element},{value},{measurement},{quality},7,0800\n")
    return "".join(lines)
