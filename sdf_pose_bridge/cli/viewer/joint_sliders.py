# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The sliders and fields of the page that move joints within their limits."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
import math
import time

import numpy as np
import viser

from sdf_pose_bridge.cli.viewer.frame_texts import html_of_lines
from sdf_pose_bridge.cli.viewer.server import Events
from sdf_pose_bridge.cli.viewer.shown_scene import JointRange, short_names
from sdf_pose_bridge.geometry.formats import PoseFormatError
from sdf_pose_bridge.geometry.pose_texts import number_from_text
from sdf_pose_bridge.geometry.units import Units
from sdf_pose_bridge.printed_text import printable, shortened

_STEPS, _STEP_S = 31, 0.05
"""Number and time of the steps in which the page moves a joint through its range."""


class _Joint:
    """A slider and a field that move one joint."""

    def __init__(
        self, gui: viser.GuiApi, names: tuple[str, str], limits: JointRange, position: float,
        units: Units, events: Events,
    ) -> None:
        self._name, name = map(printable, names)
        self._limits, unit = limits, units.angle if limits.is_angle else units.length
        self._unit = unit
        lower, upper = (unit.factor * limit for limit in limits[1:3])
        self._slider = gui.add_slider(
            self._name, lower, upper, max((upper - lower) / 1000.0, 1e-9), lower, hint=name,
            marks=((lower, f'{lower:.4g}'), (0.5 * (lower + upper), unit.name),
                   (upper, f'{upper:.4g}')))
        self._field = gui.add_text(self._name, '')
        self.move(position)
        for control in (self._slider, self._field):
            events.when(control.on_update)

    def move(self, position: float, text: str = '') -> None:
        """Move the joint; raise a PoseFormatError if ``text``, as typed, is beyond a limit."""
        limits, unit = self._limits, self._unit
        inside = min(max(position, limits.lower), limits.upper)
        if text and not (math.isfinite(position) and (
                limits.is_free or unit.rounded(inside) == unit.rounded(position))):
            lower, upper = map(unit.rounded, limits[1:3])
            msg = f'{shortened(text)} is not between {lower} and {upper} {unit.name}'
            raise PoseFormatError(msg)
        self.position, self._refusal = position if limits.is_free else inside, ''
        self._slider.value = unit.factor * inside
        self._field.value = text or unit.rounded(self.position)
        self._shown = self._slider.value, self._field.value

    def refresh(self) -> str:
        """Read the field and the slider; return the reason why the text is rejected."""
        slider, limits, text = self._slider, self._limits, self._field.value
        if text != self._shown[1]:
            self._shown = self._shown[0], text
            try:
                self.move(number_from_text(text) / self._unit.factor, text)
            except PoseFormatError as error:
                self._refusal = f'{self._name}: {error}'
        elif slider.value != self._shown[0]:
            if limits.is_free and limits.is_angle and (
                    abs(slider.value) > slider.max - 0.5 * slider.step):
                # Wrap around.
                slider.value = math.copysign(slider.max - slider.step, -slider.value)
            self.move(slider.value / self._unit.factor)
        return self._refusal


class JointSliders:
    """
    A folder with a slider and a field for each joint, and controls that move all of them.

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
        """Iterating over it moves each joint through its range."""
        self.folder = gui.add_folder('Joints', order=order, visible=bool(ranges))
        with self.folder:
            buttons = gui.add_button_group(
                'all joints', ('home', 'middle'),
                hint='home is zero, or the nearest limit; middle is between the limits')
            self._switch = gui.add_checkbox('move each joint', False, hint='through its range')
            self.joints = {
                name: _Joint(gui, (short, name), limits, positions.get(name, 0.0), units, events)
                for (name, limits), short in zip(
                    ranges.items(), short_names(ranges), strict=True)}
        events.when(buttons.on_click, lambda: self._move_all(buttons.value))
        events.when(self._switch.on_update, self._move_through_ranges)

    @property
    def positions(self) -> dict[str, float]:
        """The positions of the joints, in radians or metres."""
        return {name: joint.position for name, joint in self.joints.items()}

    def refresh(self) -> str:
        """Read all fields and sliders; return in HTML the reasons why texts are rejected."""
        reasons = [joint.refresh() for joint in self.joints.values()]
        return html_of_lines('errors', filter(None, reasons))

    def _move_all(self, place: str) -> None:
        self._switch.value, self.moves = False, iter(())
        for name, joint in self.joints.items():
            limits = self.ranges[name]
            joint.move(0.5 * (limits.lower + limits.upper) if place == 'middle' else 0.0)

    def _move_through_ranges(self) -> None:
        def moves() -> Iterator[None]:
            for name, joint in self.joints.items():
                limits = self.ranges[name]
                places = joint.position, limits.upper, limits.lower, joint.position
                for part in np.linspace(0.0, 3.0, _STEPS):
                    joint.move(float(np.interp(part, range(4), places)))
                    end_s = time.monotonic() + _STEP_S
                    while time.monotonic() < end_s:
                        yield
            self._switch.value = False
        self.moves = moves() if self._switch.value else iter(())
