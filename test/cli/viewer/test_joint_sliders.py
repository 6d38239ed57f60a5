# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""How far sliders move joints; integration/test_view_page.py moves one in a browser."""

import math
from threading import Event

import pytest

pytest.importorskip('viser', reason='needs viser')

from sdf_pose_bridge.cli.printing import DEGREES, Units
from sdf_pose_bridge.cli.viewer import joint_sliders
from sdf_pose_bridge.cli.viewer.joint_sliders import JointSliders
from sdf_pose_bridge.cli.viewer.server import Events
from sdf_pose_bridge.cli.viewer.shown_scene import JointRange, range_of_dof
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.tf.joint_motion import JointMotion
from sdf_pose_bridge.tf.parents import tf_parents_from_scene


def joint_range(kind, limit=''):
    text = f"""<sdf version="1.11"><model name="m"><link name="a"/><link name="b"/>
      <joint name="j" type="{kind}"><parent>a</parent><child>b</child>
        <axis><xyz>0 0 1</xyz>{limit}</axis></joint></model></sdf>"""
    scene = load_text(text.encode(), 'm.sdf')
    (dof,) = JointMotion(scene, tf_parents_from_scene(scene)).dofs
    return range_of_dof(dof)


@pytest.mark.parametrize(('kind', 'most'), [('revolute', math.pi), ('prismatic', 0.5)])
@pytest.mark.parametrize('limit', ['', '<limit><lower>-1</lower></limit>'])
def test_joint_without_both_limits(kind, most, limit):
    assert joint_range(kind, limit)[1:] == (-most, most, kind == 'revolute')


def test_joint_with_limits():
    assert joint_range(
        'revolute', '<limit><lower>-1</lower><upper>3</upper></limit>')[1:] == (-1, 3, False)


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
    _, button, *sliders = gui._gui_input_handle_from_uuid.values()
    button.value = True
    wake.wait(20.0)
    (action,) = events.asked()
    action()
    values = [[slider.value for slider in sliders] for _ in joints.moves]
    first, second = zip(*values, strict=True)
    assert (min(first), max(first), first[-1]) == (-3.0, -1.0, -1.0)
    assert (min(second), max(second), second[-1]) == (0.0, 1.0, 0.5)
    assert not any(j != -1.0 and k != 0.5 for j, k in values)


@pytest.mark.parametrize('end', [math.pi, -math.pi])
def test_wheel_goes_round(gui, end):
    joints = JointSliders(
        gui, {'m/j': joint_range('revolute')}, {}, Units(), Events(Event()))
    (slider,) = joints._sliders.values()
    slider.value = end
    joint_sliders._turn_on(slider)
    assert joints.positions['m/j'] == pytest.approx(slider.value) == pytest.approx(-end, abs=0.01)
    joint_sliders._turn_on(slider)
    assert slider.value == pytest.approx(-end, abs=0.01)
