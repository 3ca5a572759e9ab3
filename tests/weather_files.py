"""Weather files as their providers write them: three days, of which one has snow."""

SMET = """SMET 1.1 ASCII
[HEADER]
station_id       = WFJ2
station_name     = Weissfluhjoch
latitude         = 46.8296
longitude        = 9.8092
altitude         = 2536
nodata           = -999
tz               = 0
fields           = timestamp TA RH HS PSUM
[DATA]
2024-01-01T00:00 268.15 0.85 1.10 0.0
2024-01-02T00:00 266.15 0.95 1.40 24.0
2024-01-03T00:00 267.15 -999 1.35 0.0
"""
ICSV = """# iCSV 1.0 UTF-8
# [METADATA]
# field_delimiter = ;
# geometry = POINTZ(9.8 46.8 2536)
# srid = EPSG:4326
# nodata = -999.0
# station_id = WFJ
# [FIELDS]
# fields = timestamp;TA;HS;PSUM
# units = -;K;cm;mm
# [DATA]
2024-01-01T00:00:00;268.15;110;0.0
2024-01-02T00:00:00;266.15;140;24.0
2024-01-03T00:00:00;267.15;-999.0;0.0
"""
EPW_HEADER = """LOCATION,Davos,GR,CHE,IWEC,067840,46.82,9.85,1.0,1590.0
DESIGN CONDITIONS,0
TYPICAL/EXTREME PERIODS,0
GROUND TEMPERATURES,0
HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0
COMMENTS 1,made for a test
COMMENTS 2,
DATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31
"""


def epw_row(year, month, day, hour, dry=-5.0, depth=110, rain=0.0):
    middle = ",".join(["0"] * 23)
    return f"{year},{month},{day},{hour},60,?9?9,{dry},{middle},{depth},5,0.6,{rain},1.0"


EPW = EPW_HEADER + "\n".join(
    [epw_row(1999, 1, 1, 1), epw_row(1999, 1, 2, 1, -7.0, 140, 24.0), epw_row(1999, 1, 3, 1, -6.0)]
)
TMY3 = """724666,"BROOMFIELD/JEFFCO",CO,-7.0,39.917,-105.117,1689
Date (MM/DD/YYYY),Time (HH:MM),GHI (W/m^2),Dry-bulb (C),Lprecip depth (mm),Lprecip quantity (hr)
01/01/1996,01:00,0,-5.0,0,1
01/02/1996,01:00,0,-7.0,24,1
01/03/1996,24:00,0,-6.0,-9900,1
"""


def dly_line(element, values, station="USC00050848", month="202401"):
    cells = "".join(f"{value:5d}  7" for value in values + [-9999] * (31 - len(values)))
    return f"{station}{month}{element}{cells}"


DLY = "\n".join(
    [
        dly_line("TMAX", [-20, -40, -30]),
        dly_line("TMIN", [-80, -100, -90]),
        dly_line("PRCP", [0, 240, 0]),
        dly_line("SNOW", [0, 300, 0]),
        dly_line("SNWD", [1100, 1400, 1350]),
    ]
)
BY_STATION = "\n".join(
    f"USC00050848,202401{day:02d},{element},{value},,,7,0800"
    for element, values in {
        "TMAX": (-20, -40, -30), "TMIN": (-80, -100, -90), "SNOW": (0, 300, 0), "PRCP": (0, 240, 0)
    }.items()
    for day, value in enumerate(values, 1)
)  # fmt: skip
ACIS = """BOULDER
Date,Max Temperature,Min Temperature,Precipitation,Snowfall,Snow Depth
2024-01-01,28.4,17.6,0.00,T,43
2024-01-02,24.8,14.0,0.94,11.8,55
2024-01-03,26.6,15.8,M,0.0,53
"""
METEOSWISS = """station_abbr;reference_timestamp;tre200d0;rre150d0;hns000d0;htoautd0
DAV;01.01.2024 00:00;-5.0;0;0;110
DAV;02.01.2024 00:00;-7.0;24.0;30;140
DAV;03.01.2024 00:00;-6.0;;0;135
"""
IMIS = """station_code,measure_date,hyear,TA_30MIN_MEAN,RH_30MIN_MEAN,HS
WFJ2,2024-01-01 00:00:00+00:00,2024,-5.0,85,110
WFJ2,2024-01-02 00:00:00+00:00,2024,-7.0,95,140
WFJ2,2024-01-03 00:00:00+00:00,2024,-6.0,,135
"""

#: By format: the file, the day's new snow in m, and five damages with what the error says.
FILES = {
    "SMET": (SMET, None, [
        ("266.15", "cold", "line 13, column TA: 'cold' is not a number"),
        ("266.15", "-7.0", "line 13, column TA: -7.0 is outside the allowed range"),
        (" 1.40 24.0", " 140 24.0", "line 13, column HS: 140 is outside the allowed range"),
        ("0.95 1.40 24.0", "0.95 1.40", "line 13: 4 cells in 5 columns"),
        ("2024-01-02T", "2024-13-02T", "line 13, column timestamp: '2024-13-02T00:00' is not"),
    ]),
    "iCSV": (ICSV, None, [
        (";266.15", ";cold", "line 13, column TA: 'cold' is not a number"),
        ("K;cm;mm", "K;feet;mm", "units: 'feet' of HS; allowed"),
        (";140;", ";14000;", "line 13, column HS: 14000 is outside the allowed range"),
        (";140;24.0", ";140", "line 13: 3 cells in 4 columns"),
        ("# [DATA]\n", "", "the file ends without its section [DATA]"),
    ]),
    "EPW": (EPW, None, [
        ("-7.0", "cold", "line 10, column dry bulb temperature: 'cold' is not a number"),
        ("-7.0", "266.15", "line 10, column dry bulb temperature: 266.15 is outside"),
        ("140,5", "14000,5", "line 10, column snow depth: 14000 is outside the allowed range"),
        ("1999,1,2,", "1999,13,2,", "line 10, column day: 1999-13-2 hour 1 is no date"),
        ("DATA PERIODS", "DATA", "line 8: no line DATA PERIODS"),
    ]),
    "TMY3": (TMY3, None, [
        ("-7.0,24", "cold,24", "line 4, column Dry-bulb (C): 'cold' is not a number"),
        ("-7.0,24", "266.15,24", "line 4, column Dry-bulb (C): 266.15 is outside"),
        ("01/02/1996", "13/02/1996", "line 4, column Date (MM/DD/YYYY): '13/02/1996' is not"),
        ("24:00", "25:00", "line 5, column Time (HH:MM): 25; allowed: 01:00 to 24:00"),
        ("-7.0,24,1", "-7.0,24", "line 4: 5 cells in 6 columns"),
    ]),
    "GHCN-daily, fixed width": (DLY, 0.3, [
        ("  300  7", " lots  7", "line 4, column day 2: 'lots' is not a number"),
        ("  300  7", "30000  7", "line 4, column day 2: 30000 is outside the allowed range"),
        ("202401SNOW", "202413SNOW", "line 4, column month: '13'; allowed: 01 to 12"),
        (DLY.splitlines()[4], DLY.splitlines()[4][:98], "line 5: 98 characters; needed:"),
        ("\nUSC00050848202401TMIN", "\nTMIN", "line 2: does not begin with station"),
    ]),
    "GHCN-daily, by station": (BY_STATION, 0.3, [
        ("SNOW,300", "SNOW,lots", "line 8, column value (SNOW): 'lots' is not a number"),
        ("SNOW,300", "SNOW,30000", "line 8, column value (SNOW): 30000 is outside"),
        ("20240102,SNOW", "20241302,SNOW", "line 8, column date: '20241302' is not a date"),
        ("SNOW,300,,,7,0800", "SNOW,300,,,7", "line 8: 7 cells in 8 columns"),
        ("TMIN,-100", "TMIN,-10000", "line 5, column value (TMIN): -10000 is outside"),
    ]),
    "ACIS": (ACIS, 11.8 * 0.0254, [
        ("11.8", "lots", "line 4, column Snowfall: 'lots' is not a number"),
        ("11.8", "300", "line 4, column Snowfall: 300 is outside the allowed range"),
        ("2024-01-02", "2024-13-02", "line 4, column Date: '2024-13-02' is not a date"),
        ("11.8,55", "11.8", "line 4: 5 cells in 6 columns"),
        ("24.8", "266.15", "line 4, column Max Temperature: 266.15 is outside"),
    ]),
    "MeteoSwiss": (METEOSWISS, 0.3, [
        (";30;", ";lots;", "line 3, column hns000d0: 'lots' is not a number"),
        (";30;", ";3000;", "line 3, column hns000d0: 3000 is outside the allowed range"),
        ("02.01.2024", "02.13.2024", "line 3, column reference_timestamp: '02.13.2024 00:00'"),
        (";30;140", ";30", "line 3: 5 cells in 6 columns"),
        ("DAV;02", "ABO;02", "line 3, column station_abbr: 'ABO' is another station than 'DAV'"),
    ]),
    "IMIS": (IMIS, None, [
        ("95,140", "95,lots", "line 3, column HS: 'lots' is not a number"),
        ("95,140", "95,14000", "line 3, column HS: 14000 is outside the allowed range"),
        ("2024-01-02", "2024-13-02", "line 3, column measure_date: '2024-13-02"),
        ("95,140", "95", "line 3: 5 cells in 6 columns"),
        ("-7.0", "266.15", "line 3, column TA_30MIN_MEAN: 266.15 is outside"),
    ]),
}  # fmt: skip
