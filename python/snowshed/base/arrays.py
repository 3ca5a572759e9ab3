"""Arrays: their types, and the conversion of arguments with errors that name them."""

from __future__ import annotations

import math
import operator
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from snowshed._core import InputError
from snowshed.base.arguments import is_integer, is_number

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Booleans = NDArray[np.bool_]
AnyIntegers = NDArray[np.integer[Any]]
Numbers = NDArray[np.number[Any]]
#: Numbers of grains on voxels; 0 is air.
Labels = NDArray[np.int32]
#: Fields on many voxels.
SingleFloats = NDArray[np.float32]


def points(name: str, given: ArrayLike, dimension: int, count: Optional[int] = None) -> Floats:
    """Return rows of x, y and z.

    Parameters
    ----------
    name
        Name of the argument in messages.
    given : (n, 3), or (n, 2) in 2D
        Anything that NumPy converts to an array. Two columns are x and z; y is then zero. A table
        is read by the names of its columns: x, y and z, or names that end with ``_x`` and so on.
    dimension
        2 or 3.
    count
        Required number of rows. [default: any]

    Returns
    -------
    (n, 3)
        In double precision; a copy only if the type or the columns differ.

    Raises
    ------
    InputError
        If there are other columns or rows, or values that are not finite.

    Examples
    --------
    >>> points("positions", [[0, 1], [2, 3]], dimension=2).tolist()
    [[0.0, 0.0, 1.0], [2.0, 0.0, 3.0]]
    """
    array = number_array(name, _by_name(name, given, dimension))
    columns = (2, 3) if dimension == 2 else (3,)
    rows = "n" if count is None else str(count)
    if array.ndim != 2 or array.shape[1] not in columns or count not in (None, len(array)):
        allowed = " or ".join(f"({rows}, {size})" for size in reversed(columns))
        raise _wrong_shape(name, array, f"{allowed} in {dimension}D")
    _check_finite(name, array)
    if dimension == 2 and array.shape[1] == 3 and array[:, 1].any():
        raise InputError(f"{name}: y is not zero in 2D; two columns are x and z")
    if array.shape[1] == 2:
        array = np.insert(array, 1, 0.0, axis=1)
    return array


def column(name: str, given: ArrayLike, count: int, *, non_negative: bool = False) -> Floats:
    """Return `count` finite numbers, in double.

    Raises
    ------
    InputError
        If their number is wrong, or some are not finite, or negative where this is forbidden.

    Examples
    --------
    >>> column("masses", [1, 2], 2).tolist()
    [1.0, 2.0]
    """
    array = number_array(name, given)
    if array.shape != (count,):
        raise _wrong_shape(name, array, f"({count},), a number for each particle")
    _check_finite(name, array)
    if non_negative and count and array.min() < 0:
        at = int(array.argmin())
        raise InputError(f"{name}: {array[at]:g} at index {at}; no number may be negative")
    return array


def flags(name: str, given: ArrayLike, count: int) -> Booleans:
    """Return `count` booleans.

    Raises
    ------
    InputError
        If their number differs, or some are not booleans.

    Examples
    --------
    >>> flags("exclude", [True, False], 2).tolist()
    [True, False]
    """
    array = np.asarray(given)
    if array.dtype != bool and array.size:
        raise InputError(f"{name}: values of type {array.dtype}; only booleans are allowed")
    if array.shape != (count,):
        raise _wrong_shape(name, array, f"({count},), a boolean for each particle")
    return array.astype(bool, copy=False)


def positive(name: str, given: float) -> float:
    """Return a positive, finite number.

    Raises
    ------
    InputError
        If it is anything else.

    Examples
    --------
    >>> positive("dx", 1)
    1.0
    """
    number = finite(name, given)
    if number <= 0:
        raise InputError(f"{name}: {number:g}; it must be above 0")
    return number


def finite(name: str, given: float) -> float:
    """Return a finite number.

    Raises
    ------
    InputError
        If it is anything else.

    Examples
    --------
    >>> finite("ground_tilt_deg", 30)
    30.0
    """
    try:
        number = float(given) if is_number(given) else math.nan
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number):
        raise InputError(f"{name}: {given!r}; a finite number is needed")
    return number


def number_array(name: str, given: ArrayLike) -> Floats:
    """Return numbers as an array in double precision.

    Raises
    ------
    InputError
        If some are texts, booleans or dates, or `given` is a table, whose columns have an order.

    Examples
    --------
    >>> number_array("height", [1, 2]).tolist()
    [1.0, 2.0]
    >>> number_array("height", "2")
    Traceback (most recent call last):
    snowshed._core.InputError: height: not an array of numbers: values of type <U1
    """
    if hasattr(given, "columns"):
        raise InputError(f"{name}: a table; needed: an array, such as one of its columns")
    try:
        array = np.asarray(given)
        if array.dtype.kind in "bcSUmM":
            raise TypeError(f"values of type {array.dtype}")
        return np.asarray(array, dtype=np.float64, order="C")
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(f"{name}: not an array of numbers: {error}") from None


def _by_name(name: str, given: ArrayLike, dimension: int) -> ArrayLike:
    """Return the coordinates of a table as an array; anything else as it is."""
    titles = [str(title) for title in getattr(given, "columns", ())]
    if not hasattr(given, "columns"):
        return given
    columns = {
        axis: [title for title in titles if title == axis or title.endswith(f"_{axis}")]
        for axis in "xyz"
    }
    if dimension == 2 and not columns["y"]:
        del columns["y"]
    if any(len(matching) != 1 for matching in columns.values()):
        raise InputError(
            f"{name}: a table with the columns {', '.join(titles)}; needed: the columns x, y and "
            "z, or position_x, position_y and position_z"
        )
    table: Any = given
    return np.column_stack([np.asarray(table[title]) for (title,) in columns.values()])


def _check_finite(name: str, array: Floats) -> None:
    sound = np.isfinite(array)
    if not sound.all():
        at = tuple(int(index) for index in np.argwhere(~sound)[0])
        where = at[0] if len(at) == 1 else at
        raise InputError(f"{name}: {array[at]:g} at index {where}; all must be finite")


def _wrong_shape(name: str, array: NDArray[Any], allowed: str) -> InputError:
    return InputError(f"{name}: an array of shape {array.shape}; needed: {allowed}")


def whole_number(name: str, given: int, *, lowest: int) -> int:
    """Return an argument that must be an integer, at least `lowest`; raises InputError.

    Examples
    --------
    >>> whole_number("count", 3, lowest=0)
    3
    """
    number = operator.index(given) if is_integer(given) else lowest - 1
    if number < lowest:
        raise InputError(f"{name}: {given!r}; an integer from {lowest} is needed")
    return number
