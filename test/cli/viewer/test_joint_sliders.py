# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""How far sliders move joints; integration/test_view_page.py moves one in a browser."""

import math

import pytest

pytest.importorskip('viser', reason='needs viser')
import viser

from sdf_pose_bridge.cli.printing import METRES
from sdf_pose_bridge.cli.printing import Units
from sdf_pose_bridge.cli.viewer.joint_sliders import add_joint_sliders
from sdf_pose_bridge.cli.viewer.joint_sliders import JointRange
from sdf_pose_bridge.cli.viewer.joint_sliders import range_of_dof
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.tf.joint_motion import JointMotion
from sdf_pose_bridge.tf.parents import tf_parents_from_scene


def joint_range(kind, limit=''):
    text = f"""<sdf version="1.11"><model name="m"><link name="a"/><link name="b"/>
      <joint name="j" type="{kind}"><parent>a</parent><child>b</child>
        <axis><xyz>0 0 1</xyz>{limit}</axis></joint></model></sdf>"""
    scene = load_text(text.encode(), 'm.sdf')
    (dof,) = JointMotion(scene, tf_parents_from_scene(scene)).dofs
    return range_of_dof(dof, Units())


@pytest.mark.parametrize(('kind', 'most'), [('revolute', math.pi), ('prismatic', 0.5)])
@pytest.mark.parametrize('limit', ['', '<limit><lower>-1</lower></limit>'])
def test_joint_without_both_limits(kind, most, limit):
    assert joint_range(kind, limit)[1:] == (-most, most)


@pytest.mark.parametrize(('lower', 'upper', 'home'), [(-3, -1, -1), (1, 3, 1), (-1, 3, 0)])
def test_home_is_where_the_limits_allow_it(lower, upper, home):
    limits = joint_range(
        'revolute', f'<limit><lower>{lower}</lower><upper>{upper}</upper></limit>')
    assert limits[1:] == (lower, upper)
    assert limits.clipped(0.0) == home
    assert limits.middle == (lower + upper) / 2


@pytest.fixture
def added():
    """Returns the positions, the controls by their labels, and what each event calls."""
    server = viser.ViserServer('127.0.0.1', 0, verbose=False)
    ranges = {'m/j': JointRange(METRES, -3.0, -1.0), 'm/k': JointRange(METRES, 0.0, 1.0)}
    positions, called = {'m/j': -1.0, 'm/k': 0.0}, []
    add_joint_sliders(
        server.gui, ranges, positions, lambda happens, action: called.append((happens, action)))
    yield positions, {happens.__self__.label: (happens.__self__, action)
                      for happens, action in called}
    server.stop()


def test_all_joints_go_home_and_to_the_middle(added):
    positions, controls = added
    buttons, move_all = controls['all joints']
    sliders = [controls[label] for label in ('j [m]', 'k [m]')]
    for value, expected in (('middle', [-2.0, 0.5]), ('home', [-1.0, 0.0])):
        buttons.value = value
        move_all()
        assert [slider.value for slider, _ in sliders] == expected
        for _, take in sliders:
            take()
        assert list(positions.values()) == expected
