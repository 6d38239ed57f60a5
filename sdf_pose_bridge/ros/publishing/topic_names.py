# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Choose the frames that get a pose topic; name these topics, and those that are followed."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fnmatch import fnmatchcase
import re
from types import MappingProxyType
from typing import NamedTuple

from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.ros.log_lines import names_in_line
from sdf_pose_bridge.ros.parameters.declarations import Settings, SettingsError
from sdf_pose_bridge.ros.parameters.rules import MODEL_FIELD, MOST_TOPICS, WORLD_FIELD
from sdf_pose_bridge.tf.frame_ids import LONGEST_NAME, SHORTEST_LIMIT, topic_name_from_frame_id
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.tree import TfTree

LONGEST_FULL_NAME = 246
"""Largest length of the full name of a topic in the middleware."""

MOST_STEPS = 1_000_000_000
"""Largest product of the characters of all patterns with wildcards and of all frame ids. Comparing
so many takes some seconds in the worst case, in a thread."""

LONGEST_MATCHED = 10_000
"""Longest frame id that is compared with patterns; other threads wait for each comparison."""

_WILDCARD = re.compile(r'[*?[]')


class PoseTopics(NamedTuple):
    """The pose topics of the frames that patterns choose."""

    names: dict[str, str]
    """The name of the topic of each chosen frame id, in the order of the frame ids."""
    warning: str = ''
    """A warning about patterns that match no frame id, or the reason if there are no topics."""


class StateTopics(NamedTuple):
    """The topics of joint states and of poses of models."""

    joint_states: dict[str, str]
    """By the name of each topic, before it is remapped: the top-level model whose joints are on
    it; empty for all models."""
    model_poses: dict[str, str] = {}  # noqa: RUF012 - is not changed
    """In the same way: the scoped name of the free model whose pose is on the topic."""
    warnings: tuple[str, ...] = ()
    """A sentence about each topic that differs from the patterns."""


def pose_topics_from_patterns(
    frame_ids: Sequence[str], patterns: Sequence[str], node_name: str,
) -> PoseTopics:
    """
    Choose the frames that get a topic, and name the topics.

    :param patterns: glob patterns; ``*`` matches any text, slashes included. A frame is chosen if
        one of them matches the whole of its id. ``*`` alone chooses at most ``MOST_TOPICS``.
    :param node_name: full name of the node, which precedes the names.
    """
    limit = min(LONGEST_NAME, LONGEST_FULL_NAME - len(f'{node_name}/poses/'))
    with_wildcards = [pattern for pattern in patterns if _WILDCARD.search(pattern)]
    reason = ''
    if list(patterns) == ['*'] and len(frame_ids) > MOST_TOPICS:
        reason = (
            f'{len(frame_ids)} frames are more than {MOST_TOPICS}; name those that you want '
            'in pose_topics, such as "robot/*", or ask for all with "?*"')
    elif limit < SHORTEST_LIMIT:
        reason = (
            'the name of the node and its namespace are so long that the names of topics would be '
            'longer than the middleware allows')
    elif sum(map(len, with_wildcards)) * sum(map(len, frame_ids)) > MOST_STEPS:
        reason = (
            f'to compare {len(with_wildcards)} patterns with {len(frame_ids)} frame ids takes too '
            'long; name frames without wildcards in pose_topics, or use fewer patterns')
    if reason:
        return PoseTopics({}, f'no ~/poses/... topics: {reason}')
    chosen: set[str] = set()
    unmatched = []
    known = set(frame_ids)
    for pattern in dict.fromkeys(patterns):
        if pattern == '*':
            found = known
        elif _WILDCARD.search(pattern):
            found = {frame_id for frame_id in frame_ids
                     if len(frame_id) <= LONGEST_MATCHED and fnmatchcase(frame_id, pattern)}
        else:
            found = known & {pattern}
        chosen |= found
        if not found and pattern not in ('', '*'):
            unmatched.append(pattern)
    names = {
        frame_id: topic_name_from_frame_id(frame_id, limit)
        for frame_id in frame_ids if frame_id in chosen}
    return PoseTopics(
        names,
        f'no ~/poses/... topics for {names_in_line(unmatched)} in pose_topics: no frame id matches'
        if unmatched else '')


def state_topics_from_settings(
    settings: Settings, tree: TfTree, positions: JointPositions, full_name: Callable[[str], str],
) -> StateTopics:
    """
    Name the topics of joint states and of poses of models.

    :param positions: the joints and the free models.
    :param full_name: returns the full name of a topic, after it is remapped.
    """
    world, known = tree.world, tree.topic_models
    joint_states, warnings = topics_from_patterns(
        'joint_states_topics', settings.joint_states_topics, world, positions.models, full_name,
        'there is no world with a model that has moving joints; joint_states names one for all '
        'joints', known) if settings.use_joint_states else ({}, [])
    model_poses, others = topics_from_patterns(
        'model_pose_topics', settings.model_pose_topics, world, positions.free_models, full_name,
        f'there is no world for {WORLD_FIELD}, or no model that can move', known)
    if settings.tf_options.follows_models and not (
            positions.free_models or settings.simulator_others):
        others = [(
            'no model follows poses: all models are static, connected to the world by a joint, or '
            'left to others by anchor_models')]
    return StateTopics(joint_states, model_poses, (*warnings, *others))


def topics_from_patterns(
    parameter: str, patterns: Sequence[str], world: str, models: Sequence[str],
    full_name: Callable[[str], str], reason_for_none: str,
    topic_models: Mapping[str, str] = MappingProxyType({}),
) -> tuple[dict[str, str], list[str]]:
    """
    Name topics.

    :param patterns: names of topics, in which ``{model}`` and ``{world}`` stand for names in a
        world. Without a world, patterns with them name no topic.
    :param topic_models: the models of other topics, if they are for one.
    :return: the model of each topic, and the warnings, as in :class:`StateTopics`.
    """
    # By the full name of each topic: its models, and the name for each of them.
    places: dict[str, dict[str, str]] = {}
    topics, too_long, warnings = {}, list[str](), []
    for pattern in dict.fromkeys(patterns):
        if WORLD_FIELD in pattern and not world:
            continue
        known = {topic_models.get(pattern, '')}.intersection(models)
        for model in models if MODEL_FIELD in pattern else known or ('',):
            frame_id = model.replace(SEPARATOR, '/')
            name = pattern.replace(MODEL_FIELD, topic_name_from_frame_id(frame_id)).replace(
                WORLD_FIELD, topic_name_from_frame_id(world))
            try:
                places.setdefault(full_name(name), {}).setdefault(model, name)
            except RuntimeError:  # an RCLError, which no public name has
                too_long.append(model or name)
    for full, names in places.items():
        model, name = next(iter(names.items()))
        if len(names) > 1:
            warnings.append(
                f'{parameter} has {full} for '
                f'{names_in_line([each or "all models" for each in names])}, so messages on it '
                'can be about all models')
            model = ''
        if len(full) <= LONGEST_FULL_NAME:
            topics[name] = model
        else:
            too_long += [each or name for each in names]
    if too_long:
        warnings.insert(
            0, f'{parameter} has no topic for {names_in_line(too_long)}: its name would be longer '
            'than the middleware allows')
    if patterns and not places and not too_long:
        warnings.append(f'{parameter} names no topic, because {reason_for_none}')
    return topics, warnings


def check_number_of_topics(settings: Settings, positions: JointPositions | None) -> None:
    """
    Check that there would not be too many topics of joint states, or of poses of models.

    :param positions: the joints and the free models; None if nothing moves.
    :raises SettingsError: if there would be.
    """
    for parameter, models, what in () if positions is None else (
            ('joint_states_topics', positions.models, 'models that have moving joints'),
            ('model_pose_topics', positions.free_models, 'models that can move')):
        patterns = dict.fromkeys(settings.values[parameter])
        count = sum(len(models) if MODEL_FIELD in each else 1 for each in patterns)
        if count > MOST_TOPICS:
            sentence = (
                f'{parameter} names {count} topics with {len(models)} {what}, and at most '
                f'{MOST_TOPICS} are allowed; set it without {MODEL_FIELD}, or publish some of '
                'the models by another node')
            raise SettingsError([sentence])
