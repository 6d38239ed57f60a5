# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The sliders of the page that move joints within their limits."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
import math
import time
from typing import Any

import numpy as np
import viser

from sdf_pose_bridge.cli.viewer.server import Events
from sdf_pose_bridge.cli.viewer.shown_scene import JointRange, short_names
from sdf_pose_bridge.geometry.units import Unit, Units
from sdf_pose_bridge.names import printable

_STEPS, _STEP_S = 31, 0.05
"""Number and time of the steps in which the page moves a joint through its range."""


class JointSliders:
    """
    A folder with a slider for each joint, and buttons that move all of them.

    :param positions: the positions of joints, in radians or metres; other names are ignored, and
        joints without a position start at zero, or at the nearest limit.
    :param order: the place of the folder among others; None for the last one.
    """

    def __init__(
        self, gui: viser.GuiApi, ranges: Mapping[str, JointRange],
        positions: Mapping[str, float], units: Units, events: Events, order: float | None = None,
    ) -> None:
        self.ranges, self.units = ranges, units
        self.moves: Iterator[None] = iter(())
        """Moves each joint through its range, as far as it is iterated over."""
        self._sliders: dict[str, Any] = {}
        self.folder = gui.add_folder('Joints', order=order, visible=bool(ranges))
        with self.folder:
            buttons = gui.add_button_group(
                'all joints', ('home', 'middle'),
                hint='home is zero, or the nearest limit; middle is between the limits')
            move = gui.add_button('Move each joint through its range', color='gray')
            for (name, limits), short in zip(ranges.items(), short_names(ranges), strict=True):
                unit = self._unit(name)
                lower, upper = unit.factor * limits.lower, unit.factor * limits.upper
                at = min(max(unit.factor * positions.get(name, 0.0), lower), upper)
                self._sliders[name] = slider = gui.add_slider(
                    printable(short), lower, upper,
                    max((upper - lower) / 1000.0, 1e-9), at, hint=printable(name), marks=(
                        (lower, f'{lower:.4g}'), (0.5 * (lower + upper), unit.name),
                        (upper, f'{upper:.4g}')))
                slider.precision = unit.digits
                events.when(slider.on_update, *[partial(_turn_on, slider)] * limits.is_turn)
        events.when(buttons.on_click, lambda: self._move_all(buttons.value))
        events.when(move.on_click, self._move_through_ranges)

    @property
    def positions(self) -> dict[str, float]:
        """The positions of the joints, in radians or metres."""
        # Rounded, so that a position stays when its unit changes.
        return {name: round(slider.value / self._unit(name).factor, 12)
                for name, slider in self._sliders.items()}

    def _unit(self, name: str) -> Unit:
        return self.units.angle if self.ranges[name].is_angle else self.units.length

    def _move_all(self, place: str) -> None:
        self.moves = iter(())
        for slider in self._sliders.values():
            middle = 0.5 * (slider.min + slider.max)
            slider.value = middle if place == 'middle' else float(
                np.clip(0.0, slider.min, slider.max))

    def _move_through_ranges(self) -> None:
        def moves() -> Iterator[None]:
            for slider in self._sliders.values():
                places = slider.value, slider.max, slider.min, slider.value
                for part in np.linspace(0.0, 3.0, _STEPS):
                    slider.value = float(np.interp(part, range(4), places))
                    end_s = time.monotonic() + _STEP_S
                    while time.monotonic() < end_s:
                        yield
        self.moves = moves()


def _turn_on(wheel: Any) -> None:
    if abs(wheel.value) > wheel.max - 0.5 * wheel.step:
        # Behind one end is what is before the other one.
        wheel.value = math.copysign(wheel.max - wheel.step, -wheel.value)
