# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Convert angles between degrees and radians."""

from __future__ import annotations

import math
from typing import overload
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


@overload
def radians_from_degrees(angle_deg: float) -> float: ...
@overload
def radians_from_degrees(angle_deg: NDArray[np.float64]) -> NDArray[np.float64]: ...
def radians_from_degrees(angle_deg: float | NDArray[np.float64]) -> float | NDArray[np.float64]:
    """
    Convert degrees to radians as libsdformat does, ``deg * pi / 180``, less whole turns.

    Whole turns are exact in degrees and are not in radians, so they are taken away first.

    :param angle_deg: one angle or any array of them, finite, of any size.
    :return: radians, between two turns back and two turns forth; same shape.
    """
    if isinstance(angle_deg, np.ndarray):
        radians: NDArray[np.float64] = np.fmod(angle_deg, 360.0)
        radians *= math.pi
        radians /= 180.0
        return radians
    return math.fmod(angle_deg, 360.0) * math.pi / 180.0


@overload
def degrees_from_radians(angle_rad: float) -> float: ...
@overload
def degrees_from_radians(angle_rad: NDArray[np.float64]) -> NDArray[np.float64]: ...
def degrees_from_radians(angle_rad: float | NDArray[np.float64]) -> float | NDArray[np.float64]:
    """
    Convert radians to degrees.

    :param angle_rad: one angle or any array of them.
    :return: degrees, a right angle being exactly 90; same shape.
    """
    if isinstance(angle_rad, np.ndarray):
        degrees: NDArray[np.float64] = angle_rad * 180.0
        degrees /= math.pi
        return degrees
    return angle_rad * 180.0 / math.pi
