# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""How far sliders move joints; integration/test_view_page.py moves one in a browser."""

import math
from threading import Event

import pytest

pytest.importorskip('viser', reason='needs viser')

from sdf_pose_bridge.cli.viewer import joint_sliders
from sdf_pose_bridge.cli.viewer.joint_sliders import JointSliders
from sdf_pose_bridge.cli.viewer.server import Events
from sdf_pose_bridge.cli.viewer.shown_scene import JointRange, range_within_limits
from sdf_pose_bridge.geometry.units import DEGREES, Units


@pytest.mark.parametrize(('is_angle', 'most'), [(True, math.pi), (False, 0.5)])
@pytest.mark.parametrize('lower', [-math.inf, -1.0])
def test_joint_without_both_limits(is_angle, most, lower):
    assert range_within_limits(lower, math.inf, is_angle=is_angle) == (
        is_angle, -most, most, is_angle)


def test_joint_with_limits():
    assert range_within_limits(-1.0, 3.0, is_angle=True) == (True, -1.0, 3.0, False)


@pytest.fixture
def gui(server):
    return server.gui


def test_all_joints_go_home_and_to_the_middle(gui):
    ranges = {'m/j': JointRange(False, -3.0, -1.0), 'm/k': JointRange(True, 0.0, 1.0)}
    joints = JointSliders(
        gui, ranges, {'m/k': 0.5, 'gone': 1.0}, Units(angle=DEGREES), Events(Event()))
    assert joints.positions == {'m/j': -1.0, 'm/k': 0.5}
    first, second = joints._sliders.values()
    assert (first.label, second.label) == ('j', 'k')
    for place, expected in (('middle', [-2.0, 0.5]), ('home', [-1.0, 0.0])):
        joints._move_all(place)
        assert list(joints.positions.values()) == expected
        assert second.value == pytest.approx(math.degrees(expected[1]))


def test_each_joint_moves_through_its_range_once(gui, monkeypatch):
    monkeypatch.setattr(joint_sliders, '_STEP_S', 0.001)
    ranges = {'m/j': JointRange(False, -3.0, -1.0), 'm/k': JointRange(True, 0.0, 1.0)}
    events = Events(wake := Event())
    joints = JointSliders(gui, ranges, {'m/k': 0.5}, Units(), events)
    _, button, *_ = gui._gui_input_handle_from_uuid.values()
    button.value = True
    wake.wait(20.0)
    (action,) = events.asked()
    action()
    values = [joints.positions.values() for _ in joints.moves]
    first, second = zip(*values, strict=True)
    assert (min(first), max(first), first[-1]) == (-3.0, -1.0, -1.0)
    assert (min(second), max(second), second[-1]) == (0.0, 1.0, 0.5)
    assert not any(j != -1.0 and k != 0.5 for j, k in values)


@pytest.mark.parametrize('end', [math.pi, -math.pi])
def test_wheel_goes_round(gui, end):
    joints = JointSliders(
        gui, {'m/j': JointRange(True, -math.pi, math.pi, True)}, {}, Units(), Events(Event()))
    (slider,) = joints._sliders.values()
    slider.value = end
    joint_sliders._turn_on(slider)
    assert joints.positions['m/j'] == pytest.approx(slider.value) == pytest.approx(-end, abs=0.01)
    joint_sliders._turn_on(slider)
    assert slider.value == pytest.approx(-end, abs=0.01)
