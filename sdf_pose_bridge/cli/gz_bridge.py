# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose gz_bridge``: write the configuration of ros_gz_bridge for a file."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
import json
from pathlib import Path
import sys
from xml.sax.saxutils import escape, quoteattr

from sdf_pose_bridge.cli.arguments import add_file_arguments, add_output_argument, argument_type
from sdf_pose_bridge.cli.input_files import doubts_about_frames, scene_of, STANDARD_INPUT
from sdf_pose_bridge.cli.printing import CommandError, print_problems, write_text
from sdf_pose_bridge.errors import SdfError, SdfWarning
from sdf_pose_bridge.export.gazebo_bridge import followed_topics
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.nearest_names import hint_from_names
from sdf_pose_bridge.printed_text import printable
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.gazebo_topics import GROUPS, LEFT_OUT, ROS_TYPES
from sdf_pose_bridge.sdformat.limits import MissingInclude
from sdf_pose_bridge.tf.bridged_topics import bridged_topics, BridgedTopic
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

HELP = 'write the configuration of ros_gz_bridge for a file'
DESCRIPTION = (
    'Write the configuration of ros_gz_bridge for the plugins and sensors of a file, or the '
    'parameters of the node that match it. Topics in ROS are called /<model>/<name>.')


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_file_arguments(parser, takes_many=False)
    add_output_argument(parser, (), 'the configuration, instead of the standard output')
    parser.add_argument(
        '--only', metavar='GROUP[,GROUP...]', default=GROUPS, type=argument_type(
            lambda text: text.split(','), f'has another name than {", ".join(GROUPS)}',
            set(GROUPS).issuperset),
        help=f'write only /clock and topics of these groups: {", ".join(GROUPS)}')
    for name in ('model', 'world'):
        parser.add_argument(
            f'--{name}-name', metavar='NAME', default='',
            help=f'the {name} in Gazebo, for the file of a model that is spawned')
    parser.add_argument(
        '--node', action='store_true',
        help='write the parameters with which the node follows these topics')


def run(options: argparse.Namespace) -> int:
    """Write the configuration, or the parameters of the node; return 0."""
    path, world = options.files[0], options.world_name
    scene = scene_of(path, options, plugins=True)
    if scene.world_names and (options.model_name or world):
        msg = (f'{path} has a world; --model-name and --world-name are for the file of a model '
               'that is spawned')
        raise CommandError(msg)
    scene = scene.with_model_name(options.model_name)
    scene_of_gazebo = _scene_of_gazebo(scene, options)
    topics = bridged_topics(scene_of_gazebo, options.only, world)
    doubts = [each.doubt for each in topics if each.doubt]
    tf_options = TfOptions(
        frame_names=FrameNames.SCOPED if options.model_name else FrameNames.AUTO)
    print_problems((), (*doubts_about_frames(scene, tf_options), *doubts, *_doubts_about_ids(
        topics, scene_of_gazebo, scene, tf_options._replace(kinds=None))), sys.stderr)
    if options.node:
        parameters = {
            'use_sim_time': True,
            'sdf_file': '' if path == STANDARD_INPUT else str(Path(path).absolute()),
            'resource_paths': [str(Path(each).absolute()) for each in options.resource_paths],
            'on_missing_include': MissingInclude.SKIP.value if options.skip_missing else '',
            'model_name': '' if scene.world_names else ''.join(scene.names[1:2]),
            **followed_topics(scene_of_gazebo, topics, world)}
        lines = ['/**:', '  ros__parameters:', *(
            f'    {name}: {_yaml_from_value(value)}'
            for name, value in parameters.items() if value)]
    else:
        lines = [line for each in topics for line in _lines(each)]
        lines += [
            f'# {each.system} of "{printable(scene_of_gazebo.names[element])}": add its topics'
            for element, plugins in scene_of_gazebo.plugins.items() for each in plugins
            if each.system.lower() in LEFT_OUT and not scene_of_gazebo.roots[element]]
    write_text('\n'.join(lines) + '\n', options.output, scene.files)
    return 0


def _scene_of_gazebo(scene: Scene, options: argparse.Namespace) -> Scene:
    """Return a robot of URDF as Gazebo has it: with the sensors of links that it lumps."""
    if not scene.is_urdf or not Path(scene.path).is_file():
        return scene
    text = (f'<sdf version="1.12"><model name={quoteattr(scene.names[1])}><include merge="true">'
            f'<uri>{escape(str(Path(scene.path).absolute()))}</uri></include></model></sdf>')
    name = f'{scene.path} in Gazebo'
    return load_text(text, name, resource_paths=options.resource_paths, plugins=True)


def _doubts_about_ids(
    topics: Sequence[BridgedTopic], scene_of_gazebo: Scene, scene: Scene, options: TfOptions,
) -> Iterator[SdfWarning]:
    """Warn of frame ids in messages that the node does not publish."""
    try:
        known = ['', *tf_tree_from_scene(scene, options).frame_ids]
    except SdfError:  # it is told already
        return
    doubted: dict[str, tuple[str, int]] = {}
    for bridged in topics:
        for element, *_, topic, values in bridged.owners:
            sensor = scene_of_gazebo.sensors.get(element)
            for each in (sensor.frame_id, sensor.older_frame_id) if sensor else (
                    values.get('child_frame_id') or values.get('robot_base_frame', ''),
            ) if topic.odometry_frame else ():
                doubted.setdefault(each.replace(SEPARATOR, '/'), (bridged.gz_name, element))
    for frame_id in sorted(doubted.keys() - known):
        gz_name, element = doubted[frame_id]
        yield SdfWarning('WARNING', (
            f'messages on {gz_name} have the frame id "{frame_id}", which is none of the node'
            f'{hint_from_names(frame_id, known)}'), scene_of_gazebo.place(element))


def _lines(bridged: BridgedTopic) -> Iterator[str]:
    topic = bridged.topic
    if topic.reason:
        yield f'# {printable(bridged.gz_name)} of gz.msgs.{topic.gz_type}: {topic.reason}'
        return
    if bridged.doubt:
        yield f'# {printable(bridged.doubt.message)}'
    yield f'- ros_topic_name: {_yaml_from_value(bridged.ros_name)}'
    yield f'  gz_topic_name: {_yaml_from_value(bridged.gz_name)}'
    yield f'  ros_type_name: {ROS_TYPES[topic.gz_type]}'
    if topic.gz_type == 'Twist':
        yield f'  # ros_type_name: {ROS_TYPES[topic.gz_type]}Stamped'
    yield f'  gz_type_name: gz.msgs.{topic.gz_type}'
    yield f'  direction: {"ROS_TO_GZ" if topic.group == "commands" else "GZ_TO_ROS"}'
    yield f'  lazy: {_yaml_from_value(topic.group == "sensors")}'


def _yaml_from_value(value: object) -> str:
    # YAML has the escapes of JSON and of Python in double quotes.
    return printable(json.dumps(value, ensure_ascii=False))
