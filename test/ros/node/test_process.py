# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The executables: their names and their defaults."""

import re

from folders import ROOT
import pytest

from sdf_pose_bridge.ros.node.process import PROGRAMS, ROBOT_STATE_PUBLISHER
from sdf_pose_bridge.ros.parameters.declarations import DECLARATIONS
from sdf_pose_bridge.ros.parameters.given import settings_from_node


@pytest.mark.parametrize('program', PROGRAMS)
def test_defaults_are_values_that_are_allowed_and_differ(program):
    for name, value in PROGRAMS[program].defaults.items():
        DECLARATIONS[name].convert(value)
        assert value != DECLARATIONS[name].default
        assert type(value) is type(DECLARATIONS[name].default)


def test_the_page_about_parameters_has_the_defaults_of_robot_state_publisher():
    _, page = (ROOT / 'docs/ros_interface.md').read_text().split('and has these defaults:')
    defaults = ROBOT_STATE_PUBLISHER.defaults.items()
    off = [name for name, value in defaults if value is False]
    others = [f'{name} {value}' for name, value in defaults if value is not False]
    expected = f'{", ".join([*others, *off[:-1]])} and {off[-1]} false'.replace("'", '')
    shown = re.sub("[`']", '', page.partition('.\n')[0])
    assert shown.split() == expected.lower().split()


def test_the_bridge_has_the_defaults_of_the_declarations():
    assert not PROGRAMS['bridge'].defaults


def test_a_parameter_that_is_given_comes_before_a_default(make_node):
    node = make_node(
        'bridge', '-p', 'sdf_file:=r.urdf', '-p', 'publish_frequency:=7.0')
    settings = settings_from_node(node, ROBOT_STATE_PUBLISHER.defaults)
    assert (settings.publish_frequency, settings.use_joint_states) == (7.0, True)
    assert node.get_parameter('kinds').value == ['auto']


@pytest.mark.parametrize(('given', 'file'), [
    ([], 'a.urdf'), (['-p', 'sdf_file:=b.urdf'], 'b.urdf'),
    (['-p', 'robot_description:=<sdf/>'], '')])
def test_a_file_on_the_command_line_comes_after_parameters(make_node, given, file):
    settings = settings_from_node(
        make_node('bridge', *given), ROBOT_STATE_PUBLISHER.defaults, 'a.urdf')
    assert settings.sdf_file == file
