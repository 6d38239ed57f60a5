# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Find the topics of plugins and sensors in a file, their names in ROS, and the models they place.

A topic is called ``/<model>/<name>`` in ROS, with the model as in topics of the node. Topics of a
world, and of several plugins or sensors, have the same name as in Gazebo.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.errors import ElementMissingError, SdfWarning
from sdf_pose_bridge.geometry.chains import Indices
from sdf_pose_bridge.names import SEPARATOR, unused_name
from sdf_pose_bridge.printed_text import listed, quoted_names
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.gazebo_topics import GazeboTopic, is_true, topics_of
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.frame_ids import topic_name_from_frame_id
from sdf_pose_bridge.tf.parents import tf_parents_from_scene


class Owner(NamedTuple):
    """A plugin or a sensor that has a topic."""

    element: int
    free_model: int
    """The model that moves freely in its root, and the element with it; -1 for none."""
    system: str
    """The class of the plugin, or the type of the sensor."""
    topic: GazeboTopic
    values: Mapping[str, str]
    """The values of fields, and ``model`` for the scoped name of its model."""


class BridgedTopic(NamedTuple):
    """A topic of Gazebo."""

    gz_name: str
    ros_name: str
    model: str
    """The one model that its messages are about: a free one, or for joints a top-level one."""
    topic: GazeboTopic
    models: frozenset[int]
    """The free models whose poses its messages have, or the models whose joints."""
    owners: Sequence[Owner]
    doubt: SdfWarning | None = None
    """A warning about a topic of several plugins or sensors."""

    @property
    def pattern(self) -> str:
        """Its name in ROS with ``{model}`` for the model."""
        start = f'/{_ros_name(self.model)}/'
        is_below = self.model and self.ros_name.startswith(start)
        return f'/{{model}}/{self.ros_name.removeprefix(start)}' if is_below else self.ros_name


def bridged_topics(scene: Scene, groups: Collection[str], world: str = '') -> list[BridgedTopic]:
    """
    Find the topics of the plugins and sensors in the first world or model of a file, and /clock.

    :param scene: the scene, loaded with ``plugins=True``.
    :param world: the world in Gazebo, for a model file.
    :raises ElementMissingError: if a topic begins with the name of the world, and there is none.
    """
    free_models = tf_parents_from_scene(scene).with_free_models(scene).free_models_around()
    models_in = defaultdict[int, list[int]](list)
    for model in np.flatnonzero(free_models == np.arange(len(free_models))).tolist():
        for each in scene.with_ancestors(model):
            models_in[each].append(model)
    found = defaultdict[tuple[str, str], list[Owner]](list)
    for owner in _owners(scene, world, free_models):
        topic, values = owner.topic, owner.values
        if topic.group not in ('clock', *groups):
            pass
        elif name := topic.name(values):
            found[name, topic.gz_type].append(owner)
        elif 'W' not in values and '{W}' in topic.names[-1]:
            kind = Kind(scene.kinds[owner.element]).label
            msg = (f'the {topic.ros_name} of {kind} "{scene.names[owner.element]}" is on a topic '
                   'of the world in Gazebo, and a model file has no world; set --world-name to '
                   'the one in which the model is spawned')
            raise ElementMissingError(msg, scene.place(owner.element))
    bridged, used = [], dict[str, int]()
    for (name, _), owners in found.items():
        element, free_model, _, topic, values = owners[0]
        prefix, below, model = '', name[1:], values.get('model', '')
        if model and all(each.element == element for each in owners):
            prefix = model.partition(SEPARATOR)[0] if topic.group == 'joints' else model
            below = '/'.join(filter(None, (
                scene.names[element].removeprefix(prefix).removeprefix(SEPARATOR),
                topic.ros_name.format_map(defaultdict(str, values)))))
            prefix = f'/{_ros_name(prefix)}'
        around = model.partition(SEPARATOR)[0] if topic.group == 'joints' or free_model < 0 else (
            scene.names[free_model])
        models = frozenset(
            each for owner in owners for each in _models(owner, models_in[owner.element]))
        bridged.append(BridgedTopic(
            name, unused_name(f'{prefix}/{_ros_name(below)}', used),
            around if prefix and len(models) < 2 else '', topic, models, owners,
            _doubt(name, owners, scene)))
    return bridged


def _models(owner: Owner, models_in: Sequence[int]) -> list[int]:
    """Return the models as in :class:`BridgedTopic`, with the free models in that of a plugin."""
    element, free_model, _, topic, values = owner
    if topic.group == 'poses':
        return [each for each in models_in if is_true(values, (
            'publish_model_pose' if each == element else 'publish_nested_model_pose'))]
    found = element if topic.group == 'joints' else free_model if topic.odometry_frame else -1
    return [found] if found >= 0 else []


def _doubt(name: str, owners: Sequence[Owner], scene: Scene) -> SdfWarning | None:
    """Return a warning about a topic of several plugins or sensors."""
    element, *_, topic, _ = owners[0]
    if len(owners) == 1:
        return None
    names = [scene.names[each] for each in dict.fromkeys(each.element for each in owners)]
    whose, cure = quoted_names(names), ''
    if len(names) == 1:
        # Several plugins of a model may follow one command.
        if topic.group == 'commands':
            return None
        whose = f'{listed([each.system for each in owners])} of {whose}'
        cure = f', by <{topic.names[0].partition("}")[0].lstrip("{")}>'
    return SdfWarning('WARNING', (
        f'the topic {name} belongs to {whose}, so it has messages of all; give each a topic of '
        f'its own in the file{cure}'), scene.place(element))


def _ros_name(name: str) -> str:
    return topic_name_from_frame_id(name.replace(SEPARATOR, '/'))


def _owners(scene: Scene, world: str, free_models: Indices) -> Iterator[Owner]:
    yield from (Owner(0, -1, '', clock, {}) for clock in topics_of('server', {}))
    for element in sorted({*scene.sensors, *scene.plugins}):
        if scene.roots[element] != 0:
            continue
        models = [
            each for each in scene.with_ancestors(element) if scene.kinds[each] == Kind.MODEL]
        names = [scene.own_name(each) for each in reversed(models)]
        owners = [(each.system, each.parameters) for each in scene.plugins.get(element, ())]
        known = {'W': scene.world_of(element) or world}
        if models:
            known.update(M=names[-1], P='/model/'.join(names), model=scene.names[models[0]])
        if element in scene.sensors:
            sensor, parent = scene.sensors[element], scene.parents.item(element)
            owners.append((sensor.type, sensor.topics))
            known.update(S=scene.own_name(element), C=(
                f'{Kind(scene.kinds[parent]).label}/{scene.own_name(parent)}'))
        for system, parameters in owners:
            values = {'publish_model_pose': dict(parameters).get('publish_nested_model_pose', ''),
                      'joint_index': '0', **dict(reversed(parameters)), **known}
            values['N'] = (values.get('namespace') or values.get('robotNamespace')
                           or values.get('M', ''))
            values = {name: value for name, value in values.items() if value}
            yield from (
                Owner(element, free_models.item(element), system, each, values)
                for each in topics_of(system, values))
