"""Weather files in the layouts of their providers: three days, with snowfall on the second.

`FILES` has a file of each format and five damages to it; `VARIANTS` has further layouts of the same
days.
"""

import gzip

#: Mean temperature (degrees C), precipitation (mm) and depth of the snow cover (m) of each day.
DAYS = ((-5.0, 0.0, 1.10), (-7.0, 24.0, 1.40), (-6.0, 0.0, 1.35))
NEW_SNOW = 0.3  # m, on the second day


def hours(step=1, past_precipitation=False):
    """Yield day, hour, temperature, precipitation and depth, every `step` hours.

    Precipitation fell in the `step` hours after this time or, if `past_precipitation`, before it.
    """
    last = 0.0
    for day, (warm, rain, depth) in enumerate(DAYS, 1):
        for hour in range(0, 24, step):
            wave = 2.0 if hour < 12 else -2.0
            yield day, hour, warm + wave, (last if past_precipitation else rain) * step / 24, depth
            last = rain


def smet_rows(pattern, step=1):
    return "".join(
        pattern.format(f"2024-01-{day:02d}T{hour:02d}:00", warm + 273.15, depth, rain) + "\n"
        for day, hour, warm, rain, depth in hours(step, past_precipitation=True)
    )


SMET = """SMET 1.1 ASCII
[HEADER]
station_id       = HAL2
station_name     = Hinteralp
latitude         = 46.829600
longitude        = 9.809200
altitude         = 2536
easting          = 780845.000000
northing         = 189232.000000
epsg             = 21781
nodata           = -999
tz               = 1
source           = made for a test
fields           = timestamp TA RH VW DW RSWR HS PSUM TSG TSS
units_multiplier = 1 1 1 1 1 1 0.01 1 1 1
plot_unit        = time K - m/s ° W/m2 m kg/m2 K K
[DATA]
""" + smet_rows("{0}   {1:.2f}   0.520    2.0   -999       0   {2:.2f}  {3:.3f}   273.85   261.75 ")
SMET = "\n".join(  # depths in cm, as at stations of the SLF
    line.replace(" 1.10 ", " 110.000 ").replace(" 1.40 ", " 140.000 ").replace(" 1.35 ", " -999 ")
    if line.startswith("2024-01-0")
    else line
    for line in SMET.split("\n")
)
SMET_OLD = """SMET 0.99 ASCII
[HEADER]
station_id = made
latitude   = 46.5
longitude  = 9.8
altitude   = 1500
nodata = -9999
tz     = +01
fields = julian TA RH HS HNW   # as at older stations
units_offset = 0 273.15 0 0 0
units_multiplier  = 1 1 0.01 0.01 1
[DATA]
2460310.5\t-5.0\t52\t110\t0
2460311.5\t-7.0\t60\t140\t24.0
2460312.5\t-6.0\t-9999\t-9999\t0
"""
ICSV_FIELDS = """# iCSV 1.0 UTF-8
# [METADATA]
# field_delimiter = ,
# geometry = POINTZ(9.8 46.8 2536)
# srid = EPSG:4326
# station_id = HAL2
# station_name = Hinteralp
# nodata = -999.0
# timezone = 1
#
# [FIELDS]
"""
ICSV = (
    ICSV_FIELDS
    + """# fields = timestamp,TA,RH,HS,PSUM
# units_multipliers = 1,1,1,1,1
# units_offsets = 0,0,0,0,0
# units = -,K,1,m,kg/m2
# long_name = time,air temperature,relative humidity,snow height,precipitation
#
# [DATA]
"""
    + smet_rows("{0}:00,{1:.2f},-999.0,{2:.3f},{3:.3f}")
)
ICSV_UNITS = (
    ICSV_FIELDS.replace("= ,", "= |")
    + """# fields = timestamp|TA|HS|PSUM
# units = -|°C|cm|mm

# [DATA]
timestamp|TA|HS|PSUM
2024-01-01T00:00:00+00:00|-5.0|110|0.0
2024-01-02T00:00:00+00:00|-7.0|140|24.0
2024-01-03T00:00:00+00:00|-6.0|-999.0|0.0
"""
)
EPW_HEADER = """LOCATION,Hinteralp,GR,CHE,IWEC Data,067840,46.82,9.85,1.0,1590.0
DESIGN CONDITIONS,1,Climate Design Data 2009 ASHRAE Handbook,,Heating,1,-17.3,-14.9
TYPICAL/EXTREME PERIODS,2,Summer - Week Nearest Max Temperature,Extreme,8/ 3,8/ 9,Winter,Typical
GROUND TEMPERATURES,1,.5,,,,6.55,4.47,3.90,4.39,7.20,10.34,13.30,15.44,16.06,15.06,12.63,9.58
HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0
COMMENTS 1,"made for a test, with a comma"
COMMENTS 2, -- Ground temps produced with a standard soil diffusivity
DATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31
"""


def epw_rows(missing_depth="999", minute=60, older=False):
    rows = []
    for day, hour, warm, rain, depth in hours():
        deep = missing_depth if day == 3 else f"{100 * depth:.0f}"
        rows.append(
            f"{1995 + day},1,{day},{hour + 1},{minute},C9C9C9C9*0?9?9?9?9?9?9?9A7A7A7A7A7A7*0E8*0,"
            f"{warm:.1f},-9.8,79,84100,0,1415,288,0,0,0,0,0,0,0,340,6.7,6,6,20.0,420,9,999999999,0,"
            f"0.0500,{deep},88" + ("" if older else f",0.600,{rain:.1f},1.0")
        )
    return "\n".join(rows) + "\n"


EPW = EPW_HEADER + epw_rows()
TMY3_RADIATION = (
    ["ETR (W/m^2)", "ETRN (W/m^2)"]
    + [f"{name} {part}" for name in ("GHI", "DNI", "DHI")
       for part in ("(W/m^2)", "source", "uncert (%)")]
)  # fmt: skip
TMY3_HEAD = [
    "Date (MM/DD/YYYY)", "Time (HH:MM)", *TMY3_RADIATION,
    "Dry-bulb (C)", "Dry-bulb source", "Dry-bulb uncert (code)",
    "Dew-point (C)", "Dew-point source", "Dew-point uncert (code)",
    "Alb (unitless)", "Alb source", "Alb uncert (code)",
    "Lprecip depth (mm)", "Lprecip quantity (hr)", "Lprecip source", "Lprecip uncert (code)",
]  # fmt: skip


def tmy3(midnight="24:00"):
    rows = ['724666,"HINTERALP/FIELD",CO,-7.0,39.917,-105.117,1689', ",".join(TMY3_HEAD)]
    for day, hour, warm, rain, _ in hours():
        date, time = f"01/{day:02d}/1996", f"{hour + 1:02d}:00"
        if hour == 23:
            time = midnight
            date = f"01/{day + (midnight == '00:00'):02d}/1996"
        rows.append(
            f"{date},{time},0,0,0,1,0,0,1,0,0,1,0,{warm:.1f},A,7,-9.0,A,7,0.240,F,8,"
            + (f"{rain:.1f},1,D,9" if day == 2 or hour % 2 else "-9900,-9900,?,0")
        )
    return "\n".join(rows) + "\n"


def dly_line(element, values, flags=None, station="USC00050848", month="202401"):
    """Return a line of 269 characters; a value has flags of measurement, quality and source."""
    flags = flags or {}
    cells = "".join(
        f"{value:5d}{flags.get(day, '  7')}"
        for day, value in enumerate(values + [-9999] * (31 - len(values)), 1)
    )
    return f"{station}{month}{element}{cells}"


DLY = "\n".join(
    [
        dly_line("TMAX", [-20, -40, -30]),
        dly_line("TMIN", [-80, -100, -90]),
        dly_line("TOBS", [-70, -90, 550], {3: " I7"}),
        dly_line("PRCP", [0, 240, 0], {1: "T 7"}),
        dly_line("SNOW", [0, 300, 0], {3: "T 7"}),
        dly_line("SNWD", [1100, 1400, 9900], {3: " D7"}),  # failed a check
        dly_line("WT01", [1], month="202402"),
    ]
)  # fmt: skip
ELEMENTS = {
    "TMAX": (-20, -40, -30), "TMIN": (-80, -100, -90), "PRCP": (0, 240, 0), "SNOW": (0, 300, 0),
    "SNWD": (1100, 1400, 1350),
}  # fmt: skip
BY_STATION = "".join(
    f"USC00050848,202401{day:02d},{element},{values[day - 1]},,,7,{'0800' if day > 1 else ''}\n"
    for element, values in ELEMENTS.items()
    for day in (1, 2, 3)
).replace("20240103,SNWD,1350,,,", "20240103,SNWD,9900,,D,")
BY_STATION_HEAD = "ID,DATE,ELEMENT,DATA_VALUE,M_FLAG,Q_FLAG,S_FLAG,OBS_TIME\n"


def summaries(scale=None, begin=("STATION", "DATE", "LATITUDE", "LONGITUDE", "ELEVATION", "NAME")):
    """Return daily summaries; `scale` converts values from the units of GHCN-daily to cells."""
    constant = {
        "STATION": "USC00050848", "LATITUDE": "39.9919", "LONGITUDE": "-105.2667",
        "ELEVATION": "1671.5", "NAME": "HINTERALP, CO US",
    }  # fmt: skip
    columns = [part for element in ELEMENTS for part in (element, f"{element}_ATTRIBUTES")]
    rows = [",".join(f'"{column}"' for column in (*begin, *columns))]
    for day in (1, 2, 3):
        cells = [f'"{constant.get(column, f"2024-01-{day:02d}")}"' for column in begin]
        for element, values in ELEMENTS.items():
            value = values[day - 1]
            failed = element == "SNWD" and day == 3
            cell = f"{value:5d}" if scale is None else scale(element, value)
            cells += [f'"{cell}"', '",D,7,0800"' if failed else '",,7,0800"']
        rows.append(",".join(cells))
    return "\n".join(rows) + "\n"


def metric(element, value):
    return f"{value / 10:.1f}" if element[0] in "TP" else f"{value}"


def standard(element, value):
    if element[0] == "T":
        return f"{value * 0.18 + 32:.0f}"
    return f"{value / 254:.2f}" if element == "PRCP" else f"{value / 25.4:.1f}"


ORDERED = ("STATION", "NAME", "DATE")
ACIS = """"HINTERALP, CO"
Date,Max Temperature,Min Temperature,Avg Temperature,Precipitation,Snowfall,Snow Depth
2024-01-01,28.4,17.6,23.0,T,T,43
2024-01-02,24.8,14.0,19.4,0.94A,11.8,55
2024-01-03,26.6,15.8,21.2,M,0.0,M
"""
NOWDATA = """Date\tTemperature Maximum\tTemperature Minimum\tTemperature Average\tHDD\tCDD\tPrecipitation\tNew Snow\tSnow Depth
2024-01-01\t28.4\t17.6\t23.0\t42\t0\t0.00\t0.0\t43
2024-01-02\t24.8\t14.0\t19.4\t46\t0\t0.94\t11.8\t55
2024-01-03\t26.6\t15.8\t21.2\t44\t0\tT\tT\tM
Sum\t79.8\t47.4\t-\t132\t0\t0.94\t11.8\t-
Average\t26.6\t15.8\t21.2\t-\t-\t-\t-\t49.0
Normal\t30.1\t12.9\t21.5\t-\t-\t-\t-\t-
"""  # noqa: E501
METEOSWISS = """station_abbr;reference_timestamp;tre200d0;tre200dx;tre200dn;ure200d0;rre150d0;hns000d0;htoautd0
HAL;01.01.2024 00:00;-5;-2.1;-8.8;85.4;0;0;110
HAL;02.01.2024 00:00;-7;-4.1;-10.2;95;24;30;140
HAL;03.01.2024 00:00;-6;-3.3;-9.1;;;0;
"""  # noqa: E501
NBCN = """station/location;date;gre000d0;hto000d0;nto000d0;prestad0;rre150d0;sre000d0;tre200d0;tre200dn;tre200dx;ure200d0
HAL;20240101;66;110;-;967.4;0;362;-5;-8.8;-2.1;56.6
HAL;20240102;34;140;-;957.9;24;55;-7;-10.2;-4.1;55.3
HAL;20240103;41;-;-;962.6;-;66;-6;-9.1;-3.3;85.7
"""  # noqa: E501
IDAWEB = """MeteoSchweiz / MeteoSuisse / MeteoSvizzera / MeteoSwiss

stn;time;tre200d0;rre150d0;hns000d0;hto000d0
HAL;20240101;-5.0;0.0;0;110
HAL;20240102;-7.0;24.0;30;140

stn;time;tre200d0;rre150d0;hns000d0;hto000d0
HAL;20240103;-6.0;-;0;-
"""
TEN_MINUTES = "station_abbr;reference_timestamp;tre200s0;ure200s0;rre150z0;htoauts0\n" + "".join(
    f"HAL;{day:02d}.01.2024 {hour:02d}:{minute:02d};{warm:.1f};88.1;"
    f"{(past if minute == 0 else now) / 6:.4f};"
    f"{'' if day == 3 else f'{100 * depth:.0f}'}\n"
    for (day, hour, warm, now, depth), (*_, past, _) in zip(hours(), hours(past_precipitation=True))
    for minute in range(0, 60, 10)
)
IMIS_HEAD = (
    "station_code,measure_date,hyear,HS,TA_30MIN_MEAN,RH_30MIN_MEAN,VW_30MIN_MEAN,VW_30MIN_MAX,"
    "DW_30MIN_MEAN,DW_30MIN_SD,TSS_30MIN_MEAN,TS0_30MIN_MEAN,RSWR_30MIN_MEAN\n"
)
IMIS = IMIS_HEAD + "".join(
    f"HAL2,2024-01-{day:02d} {hour:02d}:00:00+00:00,2024,"
    f"{'' if day == 3 else f'{100 * depth:.1f}'},{warm:.2f},85.2,2.1,4.3,271.0,12.5,-9.30,-0.10,\n"
    for day, hour, warm, _, depth in hours()
)

#: By format: content; new snow of the second day, m (None: estimated by a rule); and five damages:
#: line, text, replacement, error message.
FILES = {
    "SMET": (SMET, None, [
        (43, "268.15", "cold", "line 43, column TA: 'cold' is not a number"),
        (43, "268.15", "-5.0", "line 43, column TA: -5.0 is outside the allowed range"),
        (43, "140.000", "14000.0", "line 43, column HS: 14000.0 is outside the allowed range"),
        (43, " 273.85   261.75", "", "line 43, column TSG: 8 cells in 10 columns"),
        (43, "2024-01-02T", "2024-13-02T", "line 43, column timestamp: '2024-13-02T01:00' is no"),
    ]),
    "iCSV": (ICSV, None, [
        (44, ",268.15", ",cold", "line 44, column TA: 'cold' is not a number"),
        (13, "1,1,1,1,1", "1,1,1", "line 13, column units_multipliers: '1,1,1'; needed: 5 numbers"),
        (44, ",1.400", ",140", "line 44, column HS: 140 is outside the allowed range"),
        (44, ",1.400,1.000", ",1.400", "line 44, column PSUM: 4 cells in 5 columns"),
        (18, "# [DATA]", "", "line 19, column 1: '2024-01-01T00:00:00,270.15,"),
    ]),
    "EPW": (EPW, None, [
        (34, ",-5.0,", ",cold,", "line 34, column dry bulb temperature: 'cold' is not a number"),
        (34, ",-5.0,", ",268.15,", "line 34, column dry bulb temperature: 268.15 is outside"),
        (34, ",140,", ",14000,", "line 34, column snow depth: 14000 is outside the allowed range"),
        (34, "1997,1,2,", "1997,13,2,", "line 34, column day: 1997-13-2 is not a date"),
        (8, "DATA PERIODS", "DATA", "line 8, column 1: 'DATA'; allowed: DATA PERIODS"),
    ]),
    "TMY3": (tmy3(), None, [
        (28, ",-5.0,", ",cold,", "line 28, column Dry-bulb (C): 'cold' is not a number"),
        (28, ",-5.0,", ",268.15,", "line 28, column Dry-bulb (C): 268.15 is outside"),
        (28, "01/02/", "13/02/", "line 28, column Date (MM/DD/YYYY): '13/02/1996' is not a date"),
        (28, "02:00", "25:00", "line 28, column Time (HH:MM): '25'; allowed: whole numbers from 0"),
        (28, ",1,D,9", "", "line 28, column Lprecip quantity (hr): 23 cells in 26 columns"),
    ]),
    "GHCN-daily, fixed width": (DLY, NEW_SNOW, [
        (5, "  300  7", " lots  7", "line 5, column day 2: 'lots' is not a number"),
        (5, "  300  7", "30000  7", "line 5, column day 2: 30000 is outside the allowed range"),
        (5, "202401SNOW", "202413SNOW", "line 5, column month: '13'; allowed: 01 to 12"),
        (6, DLY.splitlines()[5], DLY.splitlines()[5][:98], "line 6, column day 11: the line ends"),
        (2, "USC00050848202401TMIN", "TMIN", "line 2, column 1: 'TMIN  -80  7 -100  7 ' is no"),
    ]),
    "GHCN-daily, by station": (BY_STATION, NEW_SNOW, [
        (11, "SNOW,300", "SNOW,lots", "line 11, column DATA_VALUE (SNOW): 'lots' is not a number"),
        (11, "SNOW,300", "SNOW,30000", "line 11, column DATA_VALUE (SNOW): 30000 is outside"),
        (11, "20240102", "20241302", "line 11, column DATE: '20241302' is not a date"),
        (11, ",,,7,0800", ",,,7", "line 11, column OBS_TIME: 7 cells in 8 columns"),
        (11, "USC00050848", "USC00050849",
         "line 11, column ID: 'USC00050849' is another station than 'USC00050848'"),
    ]),
    "GHCN-daily, summaries": (summaries(), NEW_SNOW, [
        (3, '"  300"', '" lots"', "line 3, column SNOW: 'lots' is not a number"),
        (3, '"  300"', '"30000"', "line 3, column SNOW: 30000 is outside the allowed range"),
        (3, "2024-01-02", "2024-13-02", "line 3, column DATE: '2024-13-02' is not a date"),
        (3, ',",,7,0800"', ",,,7,0800", "line 3, column 17: 19 cells in 16 columns"),
        (3, "USC00050848", "USC00050849", "line 3, column STATION: 'USC00050849' is another"),
    ]),
    "ACIS": (ACIS, 11.8 * 0.0254, [
        (4, "11.8", "lots", "line 4, column Snowfall: 'lots' is not a number"),
        (4, "11.8", "300", "line 4, column Snowfall: 300 is outside the allowed range"),
        (4, "2024-01-02", "2024-13-02", "line 4, column Date: '2024-13-02' is not a date"),
        (4, ",11.8,55", ",11.8", "line 4, column Snow Depth: 6 cells in 7 columns"),
        (4, "24.8", "266.15", "line 4, column Max Temperature: 266.15 is outside"),
    ]),
    "MeteoSwiss": (METEOSWISS, NEW_SNOW, [
        (3, ";30;", ";lots;", "line 3, column hns000d0: 'lots' is not a number"),
        (3, ";30;", ";3000;", "line 3, column hns000d0: 3000 is outside the allowed range"),
        (3, "02.01.2024", "02.13.2024", "line 3, column reference_timestamp: '02.13.2024 00:00'"),
        (3, ";30;140", ";30", "line 3, column htoautd0: 8 cells in 9 columns"),
        (3, "HAL;", "ABO;", "line 3, column station_abbr: 'ABO' is another station than 'HAL'"),
    ]),
    "IMIS": (IMIS, None, [
        (27, ",140.0,", ",lots,", "line 27, column HS: 'lots' is not a number"),
        (27, ",140.0,", ",14000,", "line 27, column HS: 14000 is outside the allowed range"),
        (27, "2024-01-02", "2024-13-02", "line 27, column measure_date: '2024-13-02"),
        (27, ",-9.30,-0.10,", "", "line 27, column TSS_30MIN_MEAN: 10 cells in 13 columns"),
        (27, "-5.00", "268.15", "line 27, column TA_30MIN_MEAN: 268.15 is outside"),
    ]),
}  # fmt: skip

#: Further layouts of the same days: format, peculiarity, content, and whether the new snow of the
#: second day is measured.
VARIANTS = [
    ("SMET", "version 0.99, Julian dates, degrees C and cm by factors", SMET_OLD, False),
    ("iCSV", "units, time zones, column names repeated", ICSV_UNITS, False),
    ("EPW", "PVGIS: minute 0", EPW_HEADER + epw_rows(minute=0), False),
    ("EPW", "cp1252", EPW.replace("a test", "Gl\u00e4rnisch\u2026").encode("cp1252"), False),
    ("TMY3", "SolarAnywhere: midnight is 00:00", tmy3("00:00"), False),
    ("GHCN-daily, by station", "gzip", gzip.compress(BY_STATION.encode(), mtime=0), True),
    ("GHCN-daily, by station", "columns named", BY_STATION_HEAD + BY_STATION, True),
    ("GHCN-daily, summaries", "ordered, metric", summaries(metric, ORDERED), True),
    ("GHCN-daily, summaries", "ordered, inches", summaries(standard, ORDERED), True),
    ("ACIS", "NOWData: tabulators, sums below", NOWDATA, True),
    ("MeteoSwiss", "climate stations", NBCN, False),
    ("MeteoSwiss", "IDAWEB, two parts", IDAWEB.encode("latin-1"), True),
    ("MeteoSwiss", "ten minutes", TEN_MINUTES, False),
]  # fmt: skip
