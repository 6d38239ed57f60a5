# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The sliders of the page that move joints within their limits."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from collections.abc import Mapping
from functools import partial
import math
from typing import Any
from typing import NamedTuple

import viser

from sdf_pose_bridge.cli.printing import Unit
from sdf_pose_bridge.cli.printing import Units
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.tf.joint_motion import DegreeOfFreedom

_LARGEST_RANGE = 1000.0
"""A joint with a wider range counts as one without limits, which the page moves by half a turn or
half a metre to either side."""


class JointRange(NamedTuple):
    """Where a joint can be, in radians or metres, and the unit in which it is shown."""

    unit: Unit
    lower: float
    upper: float

    def clipped(self, position: float) -> float:
        """Return the nearest position within the limits."""
        return min(max(position, self.lower), self.upper)

    @property
    def middle(self) -> float:
        """The middle of the limits."""
        return 0.5 * (self.lower + self.upper)


def range_of_dof(dof: DegreeOfFreedom, units: Units) -> JointRange:
    """Return where a degree of freedom can be."""
    unit, most, axis = units.length, 0.5, dof.axis
    if dof.rad_per_unit:
        unit, most = units.angle, math.pi
    if axis.upper - axis.lower >= _LARGEST_RANGE:
        return JointRange(unit, -most, most)
    return JointRange(unit, axis.lower, max(axis.lower, axis.upper))


def add_joint_sliders(
    gui: viser.GuiApi, ranges: Mapping[str, JointRange], positions: dict[str, float],
    when: Callable[[Callable[..., object], Callable[[], object]], None],
) -> None:
    """
    Add a folder with a slider for each joint, and buttons that move all of them.

    :param ranges: where each joint can be, by the names in ``positions``.
    :param positions: their positions in radians or metres, which the sliders change.
    :param when: lets an event call a function.
    """
    short_names = Counter(name.rpartition('/')[2] for name in ranges)
    sliders: dict[str, Any] = {}
    with gui.add_folder('Joints'):
        buttons = gui.add_button_group(
            'all joints', ('home', 'middle'),
            hint='home is zero, or the nearest limit; middle is between the limits')
        for name, (unit, lower, upper) in ranges.items():
            short = name.rpartition('/')[2]
            sliders[name] = slider = gui.add_slider(
                f'{printable(short if short_names[short] == 1 else name)} [{unit.name}]',
                lower * unit.factor, upper * unit.factor,
                max((upper - lower) * unit.factor / 1000.0, 1e-9), positions[name] * unit.factor,
                hint=printable(name))
            when(slider.on_update, partial(_take_position, slider, positions, name, unit))

    def move_all() -> None:
        for name, limits in ranges.items():
            position = limits.middle if buttons.value == 'middle' else limits.clipped(0.0)
            sliders[name].value = position * limits.unit.factor
    when(buttons.on_click, move_all)


def _take_position(slider: Any, positions: dict[str, float], name: str, unit: Unit) -> None:
    positions[name] = slider.value / unit.factor
