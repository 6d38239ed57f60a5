# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Launch files load, describe their arguments and pass them to the right nodes."""

import os
from pathlib import Path
import xml.etree.ElementTree as ET

from folders import ROOT
import pytest

pytest.importorskip('launch_ros', reason='needs launch_ros, which is not installed')
pytest.importorskip('launch_xml', reason='needs launch_xml, which is not installed')

from launch import LaunchContext
from launch.actions import IncludeLaunchDescription
from launch.conditions import InvalidConditionExpressionError
from launch.launch_description_sources import (
    AnyLaunchDescriptionSource,
    get_launch_description_from_any_launch_file,
)
from launch.substitutions.substitution_failure import SubstitutionFailure
from launch.utilities import perform_substitutions
from launch_ros.actions import Node
from sdf_texts import world_file
import yaml

FOLDER = ROOT / 'launch'
RVIZ_FILE = FOLDER.parent / 'rviz/bridge.rviz'
VISUALS = '/sdf_pose_bridge/visuals'
FILES = sorted(path.name for path in FOLDER.glob('*.launch.*'))
BRIDGE_FILES = ['bridge.launch.py', 'bridge.launch.xml']
URDF = '<robot name="r"><link name="world"/></robot>'


def declared(name):
    description = get_launch_description_from_any_launch_file(str(FOLDER / name))
    return {each.name: each for each in description.get_launch_arguments()}


def nodes_of(name, **arguments):
    """Return the nodes that a file would start, by executable, and the context; start none."""
    context = LaunchContext()
    found = {}

    def visit(entity):
        if isinstance(entity, Node):
            # The action itself does this before it starts the process.
            entity._perform_substitutions(context)
            found[entity.node_executable] = entity
            return
        for each in entity.visit(context) or []:
            visit(each)

    visit(IncludeLaunchDescription(
        AnyLaunchDescriptionSource(str(FOLDER / name)), launch_arguments=arguments.items()))
    return found, context


def parameters_of_nodes(name, **arguments):
    """Return the parameters that each node of a file would get, by executable."""
    found = {}
    for executable, node in nodes_of(name, **arguments)[0].items():
        found[executable] = {}
        for file, is_file in node._Node__expanded_parameter_arguments:
            assert is_file
            entries, = yaml.safe_load(Path(file).read_text()).values()
            found[executable].update(entries['ros__parameters'])
    return found


def command(folder, monkeypatch, name, text):
    """Make a command that runs a text of the shell, before all others of its name."""
    file = folder / name
    file.write_text(f'#!/bin/sh\n{text}\n')
    file.chmod(0o755)
    monkeypatch.setenv('PATH', f'{folder}:{os.environ["PATH"]}')


@pytest.fixture
def rviz_installed(tmp_path, monkeypatch):
    """Make the ament index list rviz2, which needs a display and is not on most machines."""
    installed('rviz2', tmp_path, monkeypatch)


def installed(package, tmp_path, monkeypatch):
    index = tmp_path / 'share/ament_index/resource_index/packages'
    index.mkdir(parents=True)
    (index / package).touch()
    monkeypatch.setenv('AMENT_PREFIX_PATH', f'{tmp_path}:{os.environ["AMENT_PREFIX_PATH"]}')


def rviz_of(name, **arguments):
    """Return the command line of RViz and the topics that it finds under other names."""
    nodes, context = nodes_of(name, rviz='true', **arguments)
    node = nodes['rviz2']
    # After the executable come the words of the file, and then those of ROS.
    words = [perform_substitutions(context, each) for each in node.cmd[1:]]
    return words[:words.index('--ros-args')], dict(node.expanded_remapping_rules or [])


def test_these_are_the_launch_files():
    assert FILES == [
        'beside_robot_state_publisher.launch.py', 'bridge.launch.py', 'bridge.launch.xml',
        'gazebo.launch.py', 'two_robots.launch.py']


@pytest.mark.parametrize('name', FILES)
def test_every_argument_has_a_description(name):
    arguments = declared(name)
    assert arguments
    assert [each for each in arguments.values() if each.description.endswith('.')] == [
        *arguments.values()]


@pytest.mark.parametrize('name', BRIDGE_FILES)
def test_the_bridge_can_be_told_file_names_and_parameters(name):
    assert declared(name).keys() == {
        'sdf_file', 'xacro_arguments', 'namespace', 'frame_prefix', 'root_frame', 'anchor_models',
        'params_file', 'rviz'}


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


@pytest.mark.parametrize('name', BRIDGE_FILES)
def test_xacro_makes_the_text_of_a_file_for_it(name, tmp_path, monkeypatch):
    # What xacro makes of a file is tested with the real one, where it is installed.
    command(tmp_path, monkeypatch, 'xacro', 'echo "$@"')
    nodes = parameters_of_nodes(
        name, sdf_file='my arm.urdf.xacro', xacro_arguments='side:=left size:=2')
    assert nodes == {'bridge': {
        'sdf_file': '', 'robot_description': 'my arm.urdf.xacro side:=left size:=2\n'}}


def test_warnings_of_xacro_end_nothing(tmp_path, monkeypatch):
    command(tmp_path, monkeypatch, 'xacro', 'echo deprecated >&2; echo text')
    nodes = parameters_of_nodes('bridge.launch.py', sdf_file='a.xacro')
    assert nodes['bridge']['robot_description'] == 'text\n'


def test_an_error_of_xacro_is_reported(tmp_path, monkeypatch):
    command(tmp_path, monkeypatch, 'xacro', 'exit 2')
    with pytest.raises(SubstitutionFailure, match='xacro'):
        parameters_of_nodes('bridge.launch.py', sdf_file='a.xacro')


@pytest.mark.parametrize('name', BRIDGE_FILES)
def test_rviz_is_not_started_unless_it_is_asked_for(name):
    assert nodes_of(name, sdf_file='a.sdf')[0].keys() == {'bridge'}


def test_rviz_must_be_true_or_false():
    with pytest.raises(InvalidConditionExpressionError):
        nodes_of('bridge.launch.py', rviz='perhaps')


@pytest.mark.parametrize(('name', 'arguments', 'package'), [
    ('bridge.launch.py', {'rviz': 'true'}, 'rviz2, which is not installed'),
    ('gazebo.launch.py', {}, 'ros_gz_bridge, which is not installed: sudo apt')])
def test_package_that_is_not_installed_is_reported_before_anything_starts(
        monkeypatch, name, arguments, package):
    monkeypatch.setenv('AMENT_PREFIX_PATH', '/nonexistent')
    with pytest.raises(RuntimeError, match=package):
        nodes_of(name, sdf_file='a.sdf', **arguments)


@pytest.mark.parametrize('name', BRIDGE_FILES)
def test_rviz_starts_with_the_file_of_this_package(rviz_installed, name):
    (option, file), remappings = rviz_of(name, sdf_file='a.sdf')
    assert (option, Path(file).resolve(), remappings) == ('-d', RVIZ_FILE, {})


@pytest.mark.parametrize('namespace', ['left', '/left'])
def test_rviz_follows_root_frame_and_namespace(rviz_installed, namespace):
    words, remappings = rviz_of('bridge.launch.py', root_frame='map', namespace=namespace)
    assert words[2:] == ['-f', 'map']
    assert remappings == {VISUALS: f'/left{VISUALS}'}


def test_the_fixed_frame_of_rviz_is_the_root_of_what_is_published(rviz_installed, tmp_path):
    params_file = tmp_path / 'params.yaml'
    params_file.write_text('/**: {ros__parameters: {frame_prefix: r1/}}')
    file = FOLDER.parent / 'examples/mobile_robot.sdf'
    for arguments, frame in (
            ({'params_file': str(params_file)}, 'r1/chassis'),
            ({'frame_prefix': 'a/'}, 'a/chassis'),
            ({'anchor_models': 'all', 'root_frame': 'map'}, 'map')):
        words, _ = rviz_of('bridge.launch.py', sdf_file=str(file), **arguments)
        assert words[2:] == ['-f', frame]


def test_rviz_shows_frames_and_visuals():
    manager = yaml.safe_load(RVIZ_FILE.read_text())['Visualization Manager']
    assert manager['Global Options']['Fixed Frame'] == 'world'
    displays = {each['Class'].split('/')[1]: each for each in manager['Displays']}
    assert displays['TF']['Enabled']
    assert displays['MarkerArray']['Enabled']
    # As the node publishes it.
    assert displays['MarkerArray']['Topic'].items() >= {
        'Value': VISUALS, 'Durability Policy': 'Transient Local',
        'Reliability Policy': 'Reliable', 'History Policy': 'Keep Last'}.items()


def test_beside_robot_state_publisher_the_two_publish_different_frames(tmp_path):
    urdf_file = tmp_path / 'robot.urdf'
    urdf_file.write_text(URDF)
    nodes = parameters_of_nodes(
        'beside_robot_state_publisher.launch.py', urdf_file=str(urdf_file), sdf_file='cell.sdf')
    assert nodes == {
        'robot_state_publisher': {'robot_description': URDF},
        'bridge': {
            'sdf_file': 'cell.sdf', 'root_frame': 'world', 'frame_prefix': 'cell/', 'model': '',
            'anchor_models': 'all', 'publish_robot_description': False},
    }


def test_the_bridge_of_gazebo_and_the_node_get_files_that_match(tmp_path, monkeypatch):
    installed('ros_gz_bridge', tmp_path, monkeypatch)
    world = tmp_path / 'w.sdf'
    world.write_text(world_file('<model name="a"><link name="l"/><plugin filename='
                                '"gz-sim-diff-drive-system" name=""/></model>'))
    nodes = parameters_of_nodes('gazebo.launch.py', sdf_file=str(world))
    entries = yaml.safe_load(Path(nodes['parameter_bridge']['config_file']).read_text())
    assert '/a/odometry' in [each['ros_topic_name'] for each in entries]
    assert nodes['bridge'] == {
        'sdf_file': str(world), 'use_sim_time': True, 'model_pose_topics': ['/{model}/odometry']}


def test_the_bridge_of_gazebo_is_made_of_what_xacro_makes(tmp_path, monkeypatch):
    installed('ros_gz_bridge', tmp_path, monkeypatch)
    world = world_file('<model name="a"><link name="l"/></model>')
    command(tmp_path, monkeypatch, 'xacro', f"echo '{world}' > $4; echo $1 $2 > $4.arguments")
    source = tmp_path / 'w.sdf.xacro'
    nodes = parameters_of_nodes(
        'gazebo.launch.py', sdf_file=str(source), xacro_arguments='side:=left')
    found = nodes['bridge']
    assert Path(found['sdf_file']).name == 'w.sdf'
    assert found['resource_paths'] == [str(tmp_path)]
    assert Path(f'{found["sdf_file"]}.arguments').read_text() == f'{source} side:=left\n'


@pytest.mark.parametrize(('arguments', 'reason'), [
    ({}, 'FILE_READ'), ({'gazebo': 'true'}, 'needs the program gz')])
def test_an_error_of_the_file_or_a_missing_gazebo_is_reported(
        arguments, reason, tmp_path, monkeypatch):
    installed('ros_gz_bridge', tmp_path, monkeypatch)
    monkeypatch.setenv('PATH', str(tmp_path))
    with pytest.raises(RuntimeError, match=reason):
        nodes_of('gazebo.launch.py', sdf_file='none.sdf', **arguments)
