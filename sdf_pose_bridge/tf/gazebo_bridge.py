# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Find the topics of plugins and sensors in a file, their names in ROS, and parameters of the node.

A topic is called ``/<model>/<name>`` in ROS, with the model as in topics of the node. Topics of a
world, and of several plugins or sensors, have the same name as in Gazebo.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import NamedTuple

from sdf_pose_bridge.errors import ElementMissingError, SdfWarning
from sdf_pose_bridge.names import quoted_names, SEPARATOR, unused_name
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.gazebo_topics import GazeboTopic, GROUPS, is_true, topics_of
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.frame_ids import topic_name_from_frame_id


class BridgedTopic(NamedTuple):
    """A topic of Gazebo."""

    gz_name: str
    ros_name: str
    pattern: str
    """Its name in ROS with ``{model}`` for the model; for joints the top-level model."""
    topic: GazeboTopic
    model: str
    """The scoped name of its model; empty for a world."""
    places_model: bool
    """Whether its messages say where the model is."""
    doubt: SdfWarning | None = None
    """A warning about a topic of several plugins or sensors."""


def bridged_topics(scene: Scene, groups: Collection[str], world: str = '') -> list[BridgedTopic]:
    """
    Find the topics of the plugins and sensors in the first world or model of a file, and /clock.

    :param scene: the scene, loaded with ``plugins=True``.
    :param world: the world in Gazebo, for a model file.
    :raises ElementMissingError: if a topic begins with the name of the world, and there is none.
    """
    found = defaultdict[
        tuple[str, str], dict[int, tuple[GazeboTopic, Mapping[str, str]]]](dict)
    for element, topic, values in _topics(scene, world):
        if topic.group not in ('clock', *groups):
            pass
        elif name := topic.name(values):
            found[name, topic.gz_type].setdefault(element, (topic, values))
        elif 'W' not in values and '{W}' in topic.names[-1]:
            kind = Kind(scene.kinds[element]).label
            msg = (f'the {topic.ros_name} of {kind} "{scene.names[element]}" is on a topic of the '
                   'world in Gazebo, and a model file has no world; set --world-name to the one '
                   'in which the model is spawned')
            raise ElementMissingError(msg, scene.place(element))
    bridged, used = [], set[str]()
    for (name, _), owners in found.items():
        element, (topic, values) = next(iter(owners.items()))
        prefix, below, model, doubt = '', name[1:], values.get('model', ''), None
        if len(owners) > 1:
            owner_names = quoted_names([scene.names[each] for each in owners])
            doubt = SdfWarning('WARNING', (
                f'the topic {name} belongs to {owner_names}, so it has messages of all; give each '
                'a topic of its own in the file'), scene.place(element))
        elif model:
            prefix = model.partition(SEPARATOR)[0] if topic.group == 'joints' else model
            below = '/'.join(filter(None, (
                scene.names[element].removeprefix(prefix).removeprefix(SEPARATOR),
                topic.ros_name.format_map(defaultdict(str, values)))))
            prefix = f'/{_ros_name(prefix)}'
        ros_name = unused_name(f'{prefix}/{_ros_name(below)}', used)
        bridged.append(BridgedTopic(
            name, ros_name, ros_name.replace(prefix, '/{model}', 1) if prefix else ros_name, topic,
            model, bool(topic.odometry_frame) or (
                topic.group == 'poses' and is_true(values, 'publish_model_pose')), doubt))
    return bridged


def node_parameters(
    topics: Sequence[BridgedTopic], scene: Scene, world: str = '',
) -> dict[str, object]:
    """Return the parameters with which the node follows topics, found with the same arguments."""
    joints = {each.pattern for each in topics if each.topic.group == 'joints'}
    sources = sorted(
        (each for each in topics if each.places_model),
        key=lambda each: (GROUPS.index(each.topic.group), each.topic.is_of_wheels))
    followed = {each.model: each for each in reversed(sources)}
    # A pattern must not name the second source of another model.
    others = {each.pattern for each in sources if each is not followed[each.model]}
    poses = {each.ros_name if each.pattern in others else each.pattern
             for each in followed.values()}
    has_poses = any(each.topic.group == 'poses' for each in followed.values())
    return {
        'use_sim_time': True,
        'model_name': '' if scene.world_names else scene.names[1],
        'use_joint_states': bool(joints),
        'joint_states_topics': sorted(joints),
        'model_pose_topics': sorted(poses),
        'model_pose_frames': [world] if world and has_poses else []}


def _ros_name(name: str) -> str:
    return topic_name_from_frame_id(name.replace(SEPARATOR, '/'))


def _topics(scene: Scene, world: str) -> Iterator[tuple[int, GazeboTopic, Mapping[str, str]]]:
    """Iterate over elements, their topics, and the values of fields and ``model``."""
    yield from ((0, clock, {}) for clock in topics_of('server', {}))
    for element in sorted({*scene.sensors, *scene.plugins}):
        if scene.roots[element] != 0:
            continue
        models = [
            each for each in scene.with_ancestors(element) if scene.kinds[each] == Kind.MODEL]
        names = [scene.own_name(each) for each in reversed(models)]
        owners = [(each.system, each.parameters) for each in scene.plugins.get(element, ())]
        known = {'W': world or scene.world_of(element)}
        if models:
            known.update(M=names[-1], P='/model/'.join(names), model=scene.names[models[0]])
        if element in scene.sensors:
            sensor, parent = scene.sensors[element], scene.parents.item(element)
            owners.append((sensor.type, sensor.topics))
            known.update(S=scene.own_name(element), C=(
                f'{Kind(scene.kinds[parent]).label}/{scene.own_name(parent)}'))
        for owner, parameters in owners:
            values = {'publish_model_pose': dict(parameters).get('publish_nested_model_pose', ''),
                      'joint_index': '0', **dict(reversed(parameters)), **known}
            values['N'] = (values.get('namespace') or values.get('robotNamespace')
                           or values.get('M', ''))
            values = {name: value for name, value in values.items() if value}
            yield from ((element, each, values) for each in topics_of(owner, values))
