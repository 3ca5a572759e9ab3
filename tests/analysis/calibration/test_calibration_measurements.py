"""Measurement files: their values, and errors with line and column."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from snowshed import InputError
from snowshed.analysis.calibration import measurements_template, read_measurements
from snowshed.analysis.calibration.measurements import COLUMNS

HEADER = "tilt_deg,event,height_m,height_std_m,length_m,length_std_m"
ENDS = "tilt_deg,event,length_m,length_std_m,head_m,head_std_m,tail_m,tail_std_m"


def read(tmp_path, text):
    (tmp_path / "stacks.csv").write_bytes(text.encode() if isinstance(text, str) else text)
    return read_measurements(tmp_path / "stacks.csv")


def test_values_uncertainties_and_lines_are_read(tmp_path):
    measurements = read(
        tmp_path, f"# a comment\n{HEADER}\n\n40,1,0.05,0.005,,\n50, 2 ,,,0.3,0.02\n"
    )
    assert [(row.tilt, row.event, row.quantity, row.value, row.uncertainty, row.line)
            for row in measurements] == [
        (40, 1, "height", 0.05, 0.005, 4),
        (50, 2, "length", 0.3, 0.02, 5),
    ]  # fmt: skip


def test_the_template_holds_no_measured_values(tmp_path):
    lines = [line for line in measurements_template().splitlines() if not line.startswith("#")]
    assert lines[0] == ",".join(COLUMNS) and len(lines) == 1 + 2 * 5
    assert all(line.split(",")[3:] == [""] * 8 for line in lines[1:])
    with pytest.raises(InputError, match="no measurement in it"):
        read(tmp_path, measurements_template())
    filled = measurements_template().replace(
        "\n40,1,1,,,,,,,,", "\n40,1,1,0.05,0.005,0.2,0.02,0.1,0.01,0.3,0.01"
    )
    assert [row.quantity for row in read(tmp_path, filled)] == ["height", "length", "head", "tail"]


@pytest.mark.parametrize("index", [[], ["tilt_deg"], ["tilt_deg", "event"]])
def test_a_data_frame_is_read_as_its_file(tmp_path, index):
    frame = pd.DataFrame(
        {"tilt_deg": [40, 50], "event": [1, 2], "height_m": [0.05, np.nan],
         "height_std_m": [0.005, np.nan], "length_m": [0.2, 0.3], "length_std_m": [0.02, 0.02]}
    )  # fmt: skip
    frame.to_csv(tmp_path / "stacks.csv", index=False)
    from_frame = read_measurements(frame.set_index(index) if index else frame)
    from_file = read_measurements(tmp_path / "stacks.csv")
    assert from_frame == [
        replace(row, line=row.line - 1, place=f"row {row.line - 1}") for row in from_file
    ]
    assert len(from_frame) == 3


def test_errors_of_a_data_frame_name_its_row():
    frame = pd.DataFrame(
        {"tilt_deg": [40, 40], "event": 1, "height_m": [0.05, 0.06], "height_std_m": 0.01}
    )
    for wrong, message in [
        (frame, "measurements, row 2: tilt 40, event 1, round 1 is in row 1 already"),
        (frame.assign(event=[1, 2.5]), "measurements, row 2: event: 2.5 is not a whole number"),
        (frame.drop(columns="tilt_deg"), "measurements: no column tilt_deg"),
        (frame.rename(columns={"event": "tilt_deg"}), "the column 'tilt_deg' occurs twice"),
        (frame.assign(height_m=np.nan, height_std_m=np.nan), "no measurement in it"),
    ]:
        with pytest.raises(InputError, match=message):
            read_measurements(wrong)


def test_rounds_repeat_an_experiment(tmp_path):
    header = "tilt_deg,event,round,height_m,height_std_m"
    measurements = read(tmp_path, f"{header}\n40,1,1,0.05,0.005\n40,1,2,0.06,0.005\n")
    assert [row.round for row in measurements] == [1, 2]
    with pytest.raises(InputError, match="line 3: tilt 40, event 1, round 1 is in line 2 already"):
        read(tmp_path, f"{header}\n40,1,1,0.05,0.005\n40,1,,0.06,0.005\n")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "empty; `snowshed calibrate --template FILE`"),
        (b"\xff\x00", "line 1: not a table: not UTF-8 text"),
        ("tilt_deg;event\n", "line 1: its cells are separated by semicolons; separate them"),
        ("[" * 20_000, f"line 1: {'[' * 60!r}... is not a column; allowed: tilt_deg"),
        ("tilt_deg,event,height_cm\n", "line 1: 'height_cm' is not a column"),
        ("event,height_m,height_std_m\n", "line 1: no column tilt_deg"),
        ("tilt_deg,event\n", "line 1: no column of a measured value"),
        ("tilt_deg,event,head_m\n", "line 1: no column head_std_m, the uncertainty of head_m"),
        ("tilt_deg,event,event\n", "line 1: not a table: the column 'event' occurs twice"),
        (f"{HEADER}\n40,1,0.05\n", "line 2: not a table: 3 cells in 6 columns"),
        (f"{HEADER}\n40,1,0.05,,,\n", "line 2: height_std_m: missing"),
        (
            f"{HEADER}\n40,1,,0.1,,\n",
            "line 2: height_std_m: an uncertainty, although height_m is empty",
        ),
        (f"{HEADER}\n40,1,0.05,0,,\n", "line 2: height_std_m: 0 is not positive"),
        (f"{HEADER}\n40,1,-0.05,0.01,,\n", "line 2: height_m: -0.05 is not positive"),
        (f"{HEADER}\n40,1,1000,0.01,,\n", "line 2: height_m: 1000 m; at most 100 m are allowed"),
        (f"{HEADER}\n40,1,5 cm,0.01,,\n", "line 2: height_m: '5 cm' is not a number"),
        (f"{HEADER}\n40,1,nan,0.01,,\n", "line 2: height_m: 'nan' is not a number"),
        (f"{HEADER}\n,1,0.05,0.01,,\n", "line 2: tilt_deg: '' is not a number"),
        (f"{HEADER}\n90,1,0.05,0.01,,\n", "line 2: tilt_deg: 90 is outside the allowed range"),
        (f"{HEADER}\n40,0,0.05,0.01,,\n", "line 2: event: 0 is not a whole number from 1 to 1000"),
        (f"{HEADER}\n40,1.5,0.05,0.01,,\n", "line 2: event: 1.5 is not a whole number"),
        (f"{HEADER}\n40,1e300,0.05,0.01,,\n", "line 2: event: 1e+300 is not a whole number from"),
        (f'{HEADER}\n40,1,"0.05,0.01,,\n', "line 2: not a table: unexpected end of data"),
        (f"{ENDS}\n40,1,,,0.3,0.01,0.1,0.01\n", "line 2: tail_m: 0.1 is not beyond head_m, 0.3"),
        (
            f"{ENDS}\n40,1,0.5,0.01,0.1,0.01,0.3,0.01\n",
            "line 2: length_m: 0.5 is not tail_m - head_m = 0.2",
        ),
    ],
)
def test_errors_name_line_and_column(tmp_path, text, message):
    with pytest.raises(InputError) as caught:
        read(tmp_path, text)
    assert str(caught.value).partition("stacks.csv")[2][2:].startswith(message)
