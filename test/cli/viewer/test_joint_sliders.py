# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""How sliders and fields move joints; page/ moves one in a browser."""

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
        is_angle, -most, most, True)


def test_joint_with_limits():
    assert range_within_limits(-1.0, 3.0, is_angle=True) == (True, -1.0, 3.0, False)


@pytest.fixture
def gui(server):
    return server.gui


def controls(joints):
    """Return the slider and the field of each joint."""
    return [(joint._slider, joint._field) for joint in joints.joints.values()]


def test_all_joints_go_home_and_to_the_middle(gui):
    ranges = {'m/j': JointRange(False, -3.0, -1.0), 'm/k': JointRange(True, 0.0, 1.0)}
    joints = JointSliders(
        gui, ranges, {'m/k': 0.5, 'gone': 1.0}, Units(angle=DEGREES), Events(Event()))
    assert joints.positions == {'m/j': -1.0, 'm/k': 0.5}
    first, second = controls(joints)
    assert [control.label for control in (*first, *second)] == ['j', 'j', 'k', 'k']
    for place, expected in (('middle', [-2.0, 0.5]), ('home', [-1.0, 0.0])):
        joints._move_all(place)
        assert list(joints.positions.values()) == expected
        assert second[0].value == pytest.approx(math.degrees(expected[1]))
        assert float(second[1].value) == pytest.approx(second[0].value, abs=0.005)


def test_each_joint_moves_through_its_range_once(gui, monkeypatch):
    monkeypatch.setattr(joint_sliders, '_STEP_S', 0.001)
    ranges = {'m/j': JointRange(False, -3.0, -1.0), 'm/k': JointRange(True, 0.0, 1.0)}
    events = Events(wake := Event())
    joints = JointSliders(gui, ranges, {'m/k': 0.5}, Units(), events)
    joints._switch.value = True
    wake.wait(20.0)
    (action,) = events.asked()
    action()
    values = [joints.positions.values() for _ in joints.moves]
    assert joints._switch.value is False
    first, second = zip(*values, strict=True)
    assert (min(first), max(first), first[-1]) == (-3.0, -1.0, -1.0)
    assert (min(second), max(second), second[-1]) == (0.0, 1.0, 0.5)
    assert not any(j != -1.0 and k != 0.5 for j, k in values)


@pytest.mark.parametrize('end_moves', [
    lambda joints: setattr(joints._switch, 'value', False),
    lambda joints: joints._move_all('home')])
def test_moves_end_when_they_are_switched_off_or_joints_go_home(gui, end_moves):
    joints = JointSliders(
        gui, {'m/j': JointRange(False, 0.0, 1.0)}, {}, Units(), Events(Event()))
    joints._switch.value = True
    joints._move_through_ranges()
    next(joints.moves)
    end_moves(joints)
    joints._move_through_ranges()
    assert joints._switch.value is False
    assert next(joints.moves, None) is None
    assert list(joints.moves) == []


@pytest.mark.parametrize('end', [math.pi, -math.pi])
def test_wheel_goes_round(gui, end):
    joints = JointSliders(
        gui, {'m/j': JointRange(True, -math.pi, math.pi, True)}, {}, Units(), Events(Event()))
    ((slider, _),) = controls(joints)
    slider.value = end
    joints.refresh()
    assert joints.positions['m/j'] == pytest.approx(slider.value) == pytest.approx(-end, abs=0.01)
    joints.refresh()
    assert slider.value == pytest.approx(-end, abs=0.01)


LIMITS, FREE = (-1.5, 2.89724), (-math.pi, math.pi, True)


@pytest.fixture
def typed(gui):
    """Returns a joint of this range, after a text was typed, and the reason to reject it."""
    def make(text, *limits):
        joints = JointSliders(gui, {'m/j': JointRange(True, *limits)}, {'m/j': 0.25},
                              Units(angle=DEGREES), Events(Event()))
        ((_, field),) = controls(joints)
        field.value = text
        return joints, joints.refresh()
    return make


@pytest.mark.parametrize(('text', 'limits', 'degrees'), [
    ('5e-1', LIMITS, 0.5), ('1e1', LIMITS, 10.0), ('\u221230', LIMITS, -30.0),
    (' .123456', LIMITS, 0.123456),
    ('166', LIMITS, math.degrees(2.89724)), ('270', FREE, 270.0)])
def test_typed_position_is_the_one_of_the_joint(typed, text, limits, degrees):
    joints, refusal = typed(text, *limits)
    ((slider, field),) = controls(joints)
    assert (field.value, refusal) == (text, '')
    assert math.degrees(joints.positions['m/j']) == pytest.approx(degrees, abs=1e-12)
    assert slider.value == pytest.approx(min(degrees, slider.max))


@pytest.mark.parametrize(('text', 'reason'), [
    ('5e-', 'is not a number'), ('', 'is not a number'), ('0,5', 'is not a number'),
    ('400', '400 is not between -85.94 and 166.00 deg'), ('-1e3', '-1e3 is not between'),
    ('nan', 'nan is not between'), ('inf', 'inf is not between')])
def test_rejected_text_moves_nothing_until_the_slider_is_moved(typed, text, reason):
    joints, refusal = typed(text, *LIMITS)
    assert reason in refusal
    ((slider, field),) = controls(joints)
    assert (joints.positions, field.value) == ({'m/j': 0.25}, text)
    assert joints.refresh() == refusal
    slider.value = 20.0
    assert joints.refresh() == ''
    assert field.value == '20.00'
