# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Evaluate formulas for one rotation, or for many as arrays; and formulas that others share.

A formula is elementwise: a component is a float, or an array with an element for each rotation.
Its first argument ``xp`` has the functions that it calls: numpy for arrays, and :data:`FLOATS` for
floats, which is much faster for single numbers. Where only a few rotations need another formula,
``if xp.any(...)`` skips it when there are none.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
import functools
import math
import operator
from types import SimpleNamespace
from typing import Any, Generic, overload, Protocol, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]
Component: TypeAlias = Any
"""A float, or an array of floats."""

BLOCK = 8192
"""Rows in a block. Its columns and the intermediate results of a formula fit in cache."""

FLOATS = SimpleNamespace(
    all=bool, any=bool,  # a float has one condition where an array has many
    arctan2=math.atan2, copysign=math.copysign, cos=math.cos, frexp=math.frexp,
    isfinite=math.isfinite, ldexp=math.ldexp, maximum=max, minimum=min, sin=math.sin,
    sqrt=math.sqrt, where=lambda condition, if_true, if_false: if_true if condition else if_false,
)
"""Functions for floats with the names of numpy's."""

SMALLEST_SQUARE = 1e-140
LARGEST_SQUARE = 1e140
"""Squared norms between these can be multiplied with each other without overflow or underflow."""

NEARLY_UNIT = 1e-9
"""A squared norm that differs from 1 by less needs one linear correction to be 1."""

UNIT_TO_LAST_BIT = 2.25e-16
"""A squared norm differs from 1 by less where all four components are rounded correctly."""

SPLITTER = 1.5 * 2.0 ** 26
"""Adding and subtracting this rounds a number below 1 to a multiple of 2**-26."""

_Angle = TypeVar('_Angle', float, Floats)
_One = TypeVar('_One')
_Result = TypeVar('_Result')
_One_contra = TypeVar('_One_contra', contravariant=True)
_Result_co = TypeVar('_Result_co', covariant=True)


class RotationError(ValueError):
    """The numbers are not a rotation; the message names the value and the rule."""


class InvalidRotationError(ValueError):
    """
    The components of a rotation are not valid.

    The argument is False, or an array with False for each rotation that is not valid.
    """


@dataclass(frozen=True)
class Representation(Generic[_One, _Result]):
    """
    A representation of rotations by numbers.

    The types are those of one rotation in arguments and in results.
    """

    name: str
    shape: tuple[int, ...]
    message: Callable[..., str]
    """Returns the error message for a tuple of invalid numbers."""


class Conversion(Protocol[_One_contra, _Result_co]):
    """Converts one rotation or many from one representation to another."""

    formula: Callable[..., Any]
    """Takes numpy or :data:`FLOATS`, and the components of the rotation."""

    @overload
    def __call__(self, values: _One_contra) -> _Result_co: ...
    @overload
    def __call__(self, values: Floats | Sequence[Sequence[Any]]) -> Floats: ...


def conversion(
    given: Representation[_One, Any], target: Representation[Any, _Result],
) -> Callable[[Callable[..., Any]], Conversion[_One, _Result]]:
    """
    Wrap a formula: the result accepts one rotation or an array of them.

    One is a tuple or list, and the result is what the formula returns. Many are an array of shape
    (..., *given.shape), and the result has shape (..., *target.shape).
    """
    def function_from_formula(formula: Callable[..., Any]) -> Any:
        def function(values: Any) -> Any:
            if not isinstance(values, np.ndarray):
                try:
                    return formula(FLOATS, *values)
                except (TypeError, ValueError, OverflowError):
                    pass  # not one valid rotation
            array = _array(values, given)
            leading = array.shape[:array.ndim - len(given.shape)]
            rows = array.reshape(-1, math.prod(given.shape))
            results = np.empty((len(rows), math.prod(target.shape)))
            with np.errstate(all='ignore'):
                for block in row_blocks(len(rows)):
                    columns = np.ascontiguousarray(rows[block].T).reshape(*given.shape, -1)
                    try:
                        components = formula(np, *columns)
                    except InvalidRotationError as error:
                        row = block.start + int(np.argmin(error.args[0]))
                        message = given.message(tuple(rows[row].reshape(given.shape).tolist()))
                        raise RotationError(
                            f'row {row}: {message}' if leading else message) from error
                    results[block] = np.reshape(components, (results.shape[1], -1)).T
            return results.reshape(leading + target.shape)

        functools.update_wrapper(function, formula)
        # Without this attribute the function has its own arguments for tools of documentation.
        function.__dict__['formula'] = function.__dict__.pop('__wrapped__')
        return function
    return function_from_formula


def row_blocks(count: int) -> Iterator[slice]:
    """Divide the rows of an array into blocks; large arrays then take half the time."""
    for start in range(0, count, BLOCK):
        yield slice(start, start + BLOCK)


def _array(values: Any, given: Representation[Any, Any]) -> Floats:
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        msg = f'{given.name} must be numbers, but is {values!r}'
        raise RotationError(msg) from error
    if array.shape[-len(given.shape):] != given.shape:
        expected = ', '.join(map(str, given.shape))
        msg = f'{given.name} must have shape (..., {expected}), but has {array.shape}'
        raise RotationError(msg)
    return array


def radians_from_degrees(angle_deg: Floats) -> Floats:
    """
    Return radians as libsdformat does, ``deg * pi / 180``, after removing multiples of 360.

    These are exact in degrees but not in radians.
    """
    return np.fmod(angle_deg, 360.0) * math.pi / 180.0


def degrees_from_radians(angle_rad: _Angle) -> _Angle:
    """Return degrees; a right angle is exactly 90."""
    return angle_rad * 180.0 / math.pi


def orthonormality(
    xp: Any, *matrix: Sequence[Component],
) -> Iterator[tuple[Component, float, str]]:
    """Yield value, expected value and description of each property of an orthonormal matrix."""
    columns = list(zip(*matrix, strict=True))
    for what, lines in (('column', columns), ('row', matrix)):
        for index, line in enumerate(lines):
            yield xp.sqrt(dot(line, line)), 1.0, f'{what} {index} has norm'
    for first, second in ((0, 1), (0, 2), (1, 2)):
        yield (dot(columns[first], columns[second]), 0.0,
               f'columns {first} and {second} have scalar product')


def determinant(*matrix: Sequence[Component]) -> Component:
    """Return the determinant of three rows."""
    a, (bx, by, bz), (cx, cy, cz) = matrix
    return dot(a, (by * cz - bz * cy, bz * cx - bx * cz, bx * cy - by * cx))


def scaled(xp: Any, quat: Sequence[Component]) -> Any:
    """Return the components and the square, scaled by a power of two if it is extreme."""
    square = square_of(quat)
    is_usual = (square > SMALLEST_SQUARE) & (square < LARGEST_SQUARE)
    if not xp.all(is_usual):
        largest = functools.reduce(xp.maximum, map(abs, quat))
        is_finite = functools.reduce(operator.and_, map(xp.isfinite, quat))
        check(xp, is_finite & (largest > 0.0))
        exponent = xp.where(is_usual, 0, -xp.frexp(largest)[1])
        quat = tuple(xp.ldexp(component, exponent) for component in quat)
        square = square_of(quat)
    return quat, square


def corrected(xp: Any, quat: Sequence[Component]) -> Any:
    """
    Return the canonical form of a quaternion whose square is within NEARLY_UNIT of 1.

    The error of the square is computed from components that are split in two (Dekker, "A
    floating-point technique for extending the available precision", 1971): the squares of the
    high parts and their sum are exact.
    """
    x, y, z, w = quat
    x_high = x + SPLITTER - SPLITTER
    y_high = y + SPLITTER - SPLITTER
    z_high = z + SPLITTER - SPLITTER
    w_high = w + SPLITTER - SPLITTER
    error = square_of((x_high, y_high, z_high, w_high)) - 1.0 + (
        (x - x_high) * (x + x_high) + (y - y_high) * (y + y_high)
        + (z - z_high) * (z + z_high) + (w - w_high) * (w + w_high))
    correction = error * (abs(error) >= UNIT_TO_LAST_BIT) * -0.5
    x, y, z, w = x + x * correction, y + y * correction, z + z * correction, w + w * correction
    sign = xp.copysign(1.0, w)
    is_half_turn = w == 0.0
    if xp.any(is_half_turn):
        first = xp.where(x != 0.0, x, xp.where(y != 0.0, y, z))
        sign = xp.where(is_half_turn, xp.copysign(1.0, first), sign)
    # Adding zero makes -0.0 positive.
    return x * sign + 0.0, y * sign + 0.0, z * sign + 0.0, w * sign + 0.0


def square_of(quat: Sequence[Component]) -> Component:
    """Return the squared norm of a quaternion."""
    x, y, z, w = quat
    return x * x + y * y + z * z + w * w


def dot(a: Iterable[Component], b: Iterable[Component]) -> Component:
    """Return the sum of the products of components, added in their order."""
    return functools.reduce(operator.add, map(operator.mul, a, b))


def check(xp: Any, is_valid: Component) -> None:
    """Raise InvalidRotationError unless all of these are true."""
    if not xp.all(is_valid):
        raise InvalidRotationError(is_valid)
