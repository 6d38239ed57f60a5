# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The sliders of the page that move joints within their limits."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from functools import partial
import math
import time
from typing import Any, NamedTuple

import numpy as np
import viser

from sdf_pose_bridge.cli.printing import Units
from sdf_pose_bridge.cli.viewer.server import Events
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.tf.joint_motion import DegreeOfFreedom

_LARGEST_RANGE = 1000.0
"""A joint with a wider range counts as one without limits, which the page moves by half a turn or
half a metre to either side."""
_STEPS, _STEP_S = 31, 0.05
"""Number and time of the steps in which the page moves a joint through its range."""


class JointRange(NamedTuple):
    """The range of a joint, in radians or metres."""

    is_angle: bool
    lower: float
    upper: float
    is_turn: bool = False
    """Whether it is a whole turn, so that its ends are one position."""

    def clipped(self, position: float) -> float:
        """Return the nearest position within the limits."""
        return min(max(position, self.lower), self.upper)


def range_of_dof(dof: DegreeOfFreedom) -> JointRange:
    """Return the range of a degree of freedom."""
    is_angle, axis = bool(dof.rad_per_unit), dof.axis
    if axis.upper - axis.lower >= _LARGEST_RANGE:
        most = math.pi if is_angle else 0.5
        return JointRange(is_angle, -most, most, is_turn=is_angle)
    return JointRange(is_angle, axis.lower, max(axis.lower, axis.upper))


class JointSliders:
    """
    A folder with a slider for each joint, and buttons that move all of them.

    :param ranges: the range of each joint.
    :param positions: the positions of joints, in radians or metres; other names are ignored, and
        joints without a position start at zero, or at the nearest limit.
    :param units: the units of the sliders.
    :param events: the events of the page.
    """

    def __init__(
        self, gui: viser.GuiApi, ranges: Mapping[str, JointRange],
        positions: Mapping[str, float], units: Units, events: Events,
    ) -> None:
        self.positions = {
            name: limits.clipped(positions.get(name, 0.0)) for name, limits in ranges.items()}
        """The positions of the joints, in radians or metres."""
        self.moves: Iterator[None] = iter(())
        """Moves each joint through its range, as far as it is iterated over."""
        self._sliders: list[Any] = []
        if not ranges:
            return
        short_names = Counter(name.rpartition('/')[2] for name in ranges)
        with gui.add_folder('Joints'):
            buttons = gui.add_button_group(
                'all joints', ('home', 'middle'),
                hint='home is zero, or the nearest limit; middle is between the limits')
            move = gui.add_button('Move each joint through its range', color='gray')
            for name, limits in ranges.items():
                unit = units.angle if limits.is_angle else units.length
                factor, short = unit.factor, name.rpartition('/')[2]
                ends = limits.lower * factor, limits.upper * factor
                slider = gui.add_slider(
                    printable(short if short_names[short] == 1 else name), *ends,
                    max((ends[1] - ends[0]) / 1000.0, 1e-9), self.positions[name] * factor,
                    hint=printable(name), marks=(
                        (ends[0], f'{ends[0]:.4g}'), (0.5 * sum(ends), unit.name),
                        (ends[1], f'{ends[1]:.4g}')))
                slider.precision = unit.digits
                self._sliders.append(slider)
                events.when(slider.on_update, partial(
                    self._take_position, name, slider, factor, is_turn=limits.is_turn))

        def move_all() -> None:
            self.moves = iter(())
            for slider in self._sliders:
                middle = 0.5 * (slider.min + slider.max)
                slider.value = middle if buttons.value == 'middle' else float(
                    np.clip(0.0, slider.min, slider.max))
        events.when(buttons.on_click, move_all)
        events.when(move.on_click, self._move_through_ranges)

    def _take_position(self, name: str, slider: Any, factor: float, *, is_turn: bool) -> None:
        if is_turn and abs(slider.value) > slider.max - 0.5 * slider.step:
            # A wheel turns on: behind one end is what is before the other one.
            slider.value = math.copysign(slider.max - slider.step, -slider.value)
        self.positions[name] = slider.value / factor

    def _move_through_ranges(self) -> None:
        def moves() -> Iterator[None]:
            for slider in self._sliders:
                places = slider.value, slider.max, slider.min, slider.value
                for part in np.linspace(0.0, 3.0, _STEPS):
                    slider.value = float(np.interp(part, range(4), places))
                    end_s = time.monotonic() + _STEP_S
                    while time.monotonic() < end_s:
                        yield
        self.moves = moves()
