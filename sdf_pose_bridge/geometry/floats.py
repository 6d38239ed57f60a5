# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Functions for floats with the names of numpy's.

A formula that takes its functions from a module given as argument works on arrays with numpy, and
on floats with this module, which is much faster for single numbers.
"""

from __future__ import annotations

import math
from typing import TypeVar

T = TypeVar('T')

all = any = bool  # noqa: A001 - a float has one condition where an array has many
arctan2 = math.atan2
copysign = math.copysign
cos = math.cos
fmod = math.fmod
frexp = math.frexp
isfinite = math.isfinite
ldexp = math.ldexp
maximum = max
minimum = min
sin = math.sin
sqrt = math.sqrt


def where(condition: bool, if_true: T, if_false: T) -> T:  # noqa: FBT001 - as in numpy
    """Return one of two values."""
    return if_true if condition else if_false
