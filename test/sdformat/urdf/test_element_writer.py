# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Elements made from URDF: their lines and their text."""

from lxml import etree
import pytest

from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.urdf.element_writer import ElementWriter
from sdf_pose_bridge.sdformat.urdf.values import rpy_by_gz_math

YAW = Pose(1.0, 2.0, 3.0, 0.0, 0.0, 0.6, 0.8)


@pytest.fixture
def robot():
    return etree.fromstring('<robot>\n<link/></robot>')


def sources_of(robot):
    sources = Sources()
    sources.add_path('r.urdf')
    sources.add_tree('r.urdf', robot, {})
    return sources


def test_element_has_the_line_of_the_one_that_it_comes_from(robot):
    sources = sources_of(robot)
    link = ElementWriter(sources, for_ros=False).add(etree.Element('model'), 'link', robot[0])
    assert sources.line(link) == 2


@pytest.mark.parametrize(('for_ros', 'text', 'attributes'), [
    (True, '1 2 3 0 0 0.6 0.8', {'rotation_format': 'quat_xyzw'}),
    (False, '1 2 3 0 0 1.2870022175866', {}),
])
def test_pose_keeps_all_digits_for_ros_alone(robot, for_ros, text, attributes):
    model = etree.Element('model')
    ElementWriter(sources_of(robot), for_ros=for_ros).add_pose(
        model, robot[0], YAW, rpy_by_gz_math)
    written = [float(number) for number in model[0].text.split()]
    assert written == pytest.approx([float(number) for number in text.split()])
    assert dict(model[0].attrib) == attributes


@pytest.mark.parametrize(('link', 'reference'), [('world', '__model__'), ('base', 'base')])
def test_pose_in_the_link_world_is_one_in_the_model(robot, link, reference):
    model = etree.Element('model')
    ElementWriter(sources_of(robot), for_ros=False).add_pose_in_link(
        model, robot[0], YAW, link)
    assert model[0].get('relative_to') == reference


def test_numbers_have_an_element_each(robot):
    inertia = etree.Element('inertia')
    ElementWriter(sources_of(robot), for_ros=False).add_numbers(
        inertia, robot[0], {'ixx': [1.5], 'ixy': [0.0]})
    assert [(child.tag, child.text) for child in inertia] == [('ixx', '1.5'), ('ixy', '0')]
