# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Topics of plugins and sensors of Gazebo, by their parameters."""

import re
from string import Formatter

from gazebo_facts import ROS_TYPES as ROS_FACTS
from gazebo_facts import SYSTEMS, SYSTEMS_WITHOUT_TOPICS, TOPICS
import pytest

from sdf_pose_bridge.sdformat.gazebo_topics import (
    _key,
    LEFT_OUT,
    ROS_TYPES,
    SENSOR_PATHS,
    TOPICS_BY_OWNER,
    topics_of,
)
from sdf_pose_bridge.sdformat.specification import CAMERA_TYPES, CHOICES

VALUES = {'W': 'w', 'P': 'a/model/b', 'M': 'b', 'N': 'b', 'C': 'link/l', 'S': 's'}
SENSOR = '/world/w/model/a/model/b/link/l/sensor/s'


def names_of(owner, **parameters):
    values = {**VALUES, **parameters}
    return [name for each in topics_of(owner, values) if (name := each.name(values))]


@pytest.mark.parametrize('owner', [
    '', 'MyPlugin', 'my_sensor', *SYSTEMS_WITHOUT_TOPICS.split()])
def test_an_unknown_plugin_or_sensor_has_no_topics(owner):
    assert topics_of(owner, VALUES) == []


@pytest.mark.parametrize(('topic', 'name'), [
    ('@', '/model/b/cmd_vel'),
    ('~', '/model/b/cmd_vel'),
    ('/', '/model/b/cmd_vel'),
    ('drive', '/drive'),
    ('/drive/', '/drive'),
    ('my drive', '/my_drive'),
    ('a//b:=c', '/abc'),
])
def test_names_are_cleaned_as_by_gazebo(topic, name):
    assert names_of('MecanumDrive', topic=topic)[1] == name


def owner_facts():
    """Return the parameters and the facts about the topics of each owner."""
    found = []
    for line in filter(None, TOPICS.splitlines()):
        place, *words = line.split()
        if place.endswith(':'):
            owners, *parameters = words
            facts = []
            found += [(owner, dict(each.split('=') for each in parameters), facts)
                      for owner in owners.split(',')]
        else:
            assert re.fullmatch(r'([A-Za-z]+\.cc:)?[1-9][0-9]*', place)
            group, gz_type, ros_name, name = words
            facts.append((group, gz_type, ros_name, name.replace('@', SENSOR)))
    return found


@pytest.mark.parametrize(('owner', 'parameters', 'facts'), owner_facts())
def test_topics_are_those_of_the_sources(owner, parameters, facts):
    values = {**VALUES, **parameters}
    assert sorted(
        (each.group, each.gz_type, each.ros_name.format_map(values), each.name(values))
        for each in topics_of(owner, values)) == sorted(facts)


def test_each_row_with_each_of_its_names_is_held_by_a_fact():
    held = set()
    for owner, parameters, _ in owner_facts():
        values = {**VALUES, **parameters}
        for topic in topics_of(owner, values):
            name = next(each for each in topic.names if not missing_fields(each, values))
            held.add((_key(owner).removesuffix('_camera'), topic.gz_type, topic.ros_name, name))
    assert held == {
        (owner, topic.gz_type, topic.ros_name, name) for owner, topics in TOPICS_BY_OWNER.items()
        for topic in topics for name in topic.names}


def test_each_class_of_plugins_has_topics_or_is_named_or_has_none():
    with_topics = {each.lower() for each in TOPICS_BY_OWNER if not each.islower()}
    without = {*SYSTEMS_WITHOUT_TOPICS.lower().split()}
    known = [*with_topics, *LEFT_OUT, *without]
    assert sorted(known) == sorted(SYSTEMS.lower().split())


SENSORS = {owner: topics for owner, topics in TOPICS_BY_OWNER.items() if owner.islower()}
WITHOUT_TOPICS = {'custom', 'rfid', 'rfidtag', 'sonar', 'wireless_receiver',
                  'wireless_transmitter', 'multicamera'}
"""The types of sensors that have no row."""


@pytest.mark.parametrize(('types', 'owners'), [
    (CHOICES['sensor_type'].texts, SENSORS.keys() - {'server'}),
    (CAMERA_TYPES, {owner for owner, topics in SENSORS.items()
                    if 'CameraInfo' in (each.gz_type for each in topics)}),
], ids=['all', 'cameras'])
def test_types_of_sensors_are_those_of_the_specification(types, owners):
    assert {each.removesuffix('_camera') for each in types} - WITHOUT_TOPICS == owners


@pytest.mark.parametrize('owner', SENSORS)
def test_what_topics_of_a_sensor_depend_on_is_read(owner):
    names = [name for topic in SENSORS[owner] for name in topic.names]
    conditions = {each.lstrip('!') for topic in SENSORS[owner] for each in topic.conditions}
    fields = set().union(conditions, *(missing_fields(name, VALUES) for name in names))
    assert fields <= {*SENSOR_PATHS}


def missing_fields(name, values):
    return {field for _, field, *_ in Formatter().parse(name) if field} - values.keys()


def test_types_in_ros_are_those_of_ros_gz_bridge():
    facts = [line.split()[1:] for line in ROS_FACTS.strip().splitlines()]
    assert dict(facts) == ROS_TYPES
    bridged = {topic.gz_type for topics in TOPICS_BY_OWNER.values() for topic in topics
               if not topic.reason}
    assert bridged == ROS_TYPES.keys()


@pytest.mark.parametrize(('owner', 'parameters', 'names'), [
    ('Jointstatepublisher', {'topic': 'js'}, ['/js']),
    ('JointController', {}, []),
    ('Thruster', {'topic': '/t', 'use_angvel_cmd': 'true'}, ['/bt']),
    ('camera', {'topic': 'c'}, ['/c', '/camera_info']),
])
def test_names(owner, parameters, names):
    assert names_of(owner, **parameters) == names


@pytest.mark.parametrize(('parameter', 'gz_type'), [
    ('', 'Pose'), ('false', 'Pose'), ('true', 'Pose_V'), ('1', 'Pose_V')])
def test_parameters_decide_on_types(parameter, gz_type):
    topic, = topics_of('PosePublisher', {'use_pose_vector_msg': parameter})
    assert topic.gz_type == gz_type


@pytest.mark.parametrize('owner', [
    'lidar', 'ray', 'air_speed', 'logical_camera', 'SceneBroadcaster'])
def test_topics_that_cannot_be_bridged_have_a_reason(owner):
    assert all(each.reason for each in topics_of(owner, VALUES))
