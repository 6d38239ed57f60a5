# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Launch files load, describe their arguments and pass them to the right nodes."""

from pathlib import Path
import xml.etree.ElementTree as ET

import pytest

pytest.importorskip('launch_ros', reason='needs launch_ros, which is not installed')
pytest.importorskip('launch_xml', reason='needs launch_xml, which is not installed')

from launch import LaunchContext
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import AnyLaunchDescriptionSource
from launch.launch_description_sources import get_launch_description_from_any_launch_file
from launch_ros.actions import Node
import yaml

FOLDER = Path(__file__).resolve().parents[1] / 'launch'
FILES = sorted(path.name for path in FOLDER.glob('*.launch.*'))
URDF = '<robot name="r"><link name="world"/></robot>'


def declared(name):
    description = get_launch_description_from_any_launch_file(str(FOLDER / name))
    return {each.name: each for each in description.get_launch_arguments()}


def parameters_of_nodes(name, **arguments):
    """Return the parameters that each node of a file would get, by executable; start none."""
    context = LaunchContext()
    found = {}

    def visit(entity):
        if isinstance(entity, Node):
            # The action itself does this before it starts the process.
            entity._perform_substitutions(context)
            (file, is_file), = entity._Node__expanded_parameter_arguments
            assert is_file
            entries, = yaml.safe_load(Path(file).read_text(encoding='utf-8')).values()
            found[entity.node_executable] = entries['ros__parameters']
            return
        for each in entity.visit(context) or []:
            visit(each)

    visit(IncludeLaunchDescription(
        AnyLaunchDescriptionSource(str(FOLDER / name)), launch_arguments=arguments.items()))
    return found


def test_these_are_the_launch_files():
    assert FILES == [
        'beside_robot_state_publisher.launch.py', 'bridge.launch.py', 'bridge.launch.xml',
        'two_robots.launch.py']


@pytest.mark.parametrize('name', FILES)
def test_every_argument_has_a_description(name):
    arguments = declared(name)
    assert arguments
    assert [each for each in arguments.values() if each.description.endswith('.')] == [
        *arguments.values()]


@pytest.mark.parametrize('name', ['bridge.launch.py', 'bridge.launch.xml'])
def test_the_bridge_can_be_told_file_names_and_parameters(name):
    assert declared(name).keys() == {
        'sdf_file', 'namespace', 'frame_prefix', 'root_frame', 'params_file'}


def test_both_forms_say_the_same_of_their_arguments():
    python, xml = (
        {each.name: each.description for each in declared(f'bridge.launch.{form}').values()}
        for form in ('py', 'xml'))
    assert python == xml


def test_the_xml_form_hands_on_every_argument():
    root = ET.parse(FOLDER / 'bridge.launch.xml').getroot()
    assert {each.get('name') for each in root.findall('arg')} == {
        each.get('name') for each in root.findall('include/arg')}


@pytest.mark.parametrize('value', ['1', 'true', '0.5', 'null', 'map'])
def test_a_value_stays_text_whatever_it_looks_like(value):
    nodes = parameters_of_nodes('bridge.launch.py', sdf_file='a.sdf', root_frame=value)
    assert nodes == {'bridge': {'sdf_file': 'a.sdf', 'root_frame': value}}


def test_beside_robot_state_publisher_the_two_publish_different_frames(tmp_path):
    urdf_file = tmp_path / 'robot.urdf'
    urdf_file.write_text(URDF, encoding='utf-8')
    nodes = parameters_of_nodes(
        'beside_robot_state_publisher.launch.py', urdf_file=str(urdf_file), sdf_file='cell.sdf')
    assert nodes == {
        'robot_state_publisher': {'robot_description': URDF},
        'bridge': {
            'sdf_file': 'cell.sdf', 'root_frame': 'world', 'frame_prefix': 'cell/', 'model': ''},
    }
