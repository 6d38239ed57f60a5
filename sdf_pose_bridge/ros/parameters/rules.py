# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The rules for values of parameters.

A function ``<rule>_setting`` returns the setting of a value. If the value is not allowed, it
raises ValueError with the end of a sentence that begins with "parameter <name>".
"""

from __future__ import annotations

import array
from collections.abc import Sequence
from pathlib import Path

from rclpy.exceptions import InvalidTopicNameException
from rclpy.validate_full_topic_name import validate_full_topic_name
from rclpy.validate_topic_name import validate_topic_name

from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.nearest_names import hint_from_names
from sdf_pose_bridge.printed_text import printable, shortened
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.anchors import AnchorModels, AnchorPatterns, anchors_from_text

PUBLISHED_KINDS = {
    kind.label: kind for kind in Kind if kind not in (Kind.ROOT, Kind.WORLD, Kind.ACTOR)}
"""The kinds of element that can become frames, by their names."""

AUTO_KINDS = 'auto'
"""The name for the default kinds of the format of the file."""

MODEL_FIELD, WORLD_FIELD = '{model}', '{world}'
"""Placeholders for a model and for the world in names of topics."""

STATES_SERVICE = 'get_entities_states'
"""The name of the service of simulators, in the package simulation_interfaces."""

LOWEST_RATE = 0.001
"""The lowest rate in Hz, except 0.0."""

HIGHEST_RATE = 100.0
"""The limit of ``publish_rate`` in Hz."""

HIGHEST_FREQUENCY = 1000.0
"""The limit of ``publish_frequency`` in Hz, as in robot_state_publisher."""

MOST_VALUES = 1000
"""Largest number of patterns or directories of a parameter. Each pattern is compared with each
frame, and each directory is searched for each include."""

MOST_TOPICS = 1000
"""Largest number of topics that are made by default; each takes time and memory."""

MOST_CHARACTERS = 255
"""Largest length of a name or a pattern; a prefix is part of every frame id."""

MOST_CHARACTERS_OF_PATH = 4096
"""Largest length of a path, as in Linux, and of a name with scopes."""

MOST_CHARACTERS_OF_FILE = 10_000_000
"""Largest length of the text of a file; larger files have a path."""

MOST_CHARACTERS_OF_SEPARATOR = 8
"""Largest length of a separator, which a frame id contains many times."""


def root_frame_setting(value: str) -> str:
    """Reject texts that are no frame id of the root."""
    if not value or value.startswith('/'):
        raise refusal(value, 'a frame id, not empty and without a leading slash')
    return _name_setting(value)


def prefix_setting(value: str) -> str:
    """Return the beginning of frame ids without its leading slash, as tf2 drops it."""
    return _name_setting(value.removeprefix('/'))


def separator_setting(value: str) -> str:
    """Reject invalid separators of the parts of frame ids."""
    if not value:
        raise refusal(value, 'at least one character, or names run together')
    return _name_setting(value)


def kinds_setting(values: Sequence[str]) -> frozenset[Kind] | None:
    """Return the kinds of elements by their names; None for ``auto`` alone."""
    if list(values) == [AUTO_KINDS]:
        return None
    rule = f'"{AUTO_KINDS}" alone, or made of {", ".join(PUBLISHED_KINDS)}'
    if not values:
        raise refusal([], rule)
    for value in values:
        if value not in PUBLISHED_KINDS:
            raise refusal(value, f'{rule}{hint_from_names(value, PUBLISHED_KINDS)}')
    return frozenset(PUBLISHED_KINDS[value] for value in values)


def topic_patterns_setting(values: Sequence[str]) -> tuple[str, ...]:
    """Reject texts that do not become names of topics, and none."""
    if not values:
        raise refusal([], 'at least one name of a topic')
    return optional_topic_patterns_setting(values)


def optional_topic_patterns_setting(values: Sequence[str]) -> tuple[str, ...]:
    """Reject texts that do not become names of topics."""
    for value in values:
        name = value.replace(MODEL_FIELD, 'model').replace(WORLD_FIELD, 'world')
        if '{' in name or '}' in name:
            raise refusal(
                value, f'the name of a topic with no other braces than {MODEL_FIELD} and '
                f'{WORLD_FIELD}')
        _check_ros_name(value, name, 'the name of a topic')
    return tuple(values)


def simulator_setting(value: str) -> str:
    """Return the name of the service by its name, or by that of its node; reject other texts."""
    if not value:
        return ''
    name = value if value.endswith(f'/{STATES_SERVICE}') else (
        f'{value.removesuffix("/")}/{STATES_SERVICE}')
    _check_ros_name(value, name, 'the name of a node or of its service, such as /gzserver, or /')
    return name


def entity_setting(value: str) -> str:
    """Reject texts that are no name of an entity."""
    if not value or value.count(MODEL_FIELD) > 1:
        raise refusal(value, f'the name of an entity, with {MODEL_FIELD} at most once')
    return _name_setting(value)


def model_name_setting(value: str) -> str:
    """Reject texts that are no name of a single model."""
    if SEPARATOR in value or value.startswith('/'):
        raise refusal(value, f'the name of one model, without "{SEPARATOR}" and a leading slash')
    return _name_setting(value)


def _check_ros_name(value: str, name: str, what: str) -> None:
    try:
        validate_topic_name(name)
        # It finds less, such as no repeated slashes.
        validate_full_topic_name(f'/{name.removeprefix("~").removeprefix("/")}')
    except InvalidTopicNameException as error:
        # The other lines show the name and the place.
        reason = str(error).partition('\n')[0].partition(': ')[2].rstrip(':')
        raise refusal(value, f'{what}: {reason}') from None


def anchors_setting(value: str) -> AnchorModels | AnchorPatterns:
    """Reject texts that are neither a word nor patterns."""
    check_size(value.split(','), MOST_CHARACTERS_OF_PATH)
    try:
        return anchors_from_text(value)
    except ValueError as error:
        raise refusal(value, str(error)) from None


def directories_setting(values: Sequence[str]) -> tuple[Path, ...]:
    """Return the paths without empty ones."""
    try:
        return tuple(Path(path := value).expanduser() for value in values if value)
    except RuntimeError:
        raise refusal(path, 'a path; "~name" needs a user of this name') from None


def check_size(value: object, most_characters: int) -> None:
    """Reject a text or a list with a text that is too long, and a list that is too long."""
    values = value if isinstance(value, list | array.array) else [value]
    if len(values) > MOST_VALUES:
        msg = f'has {len(values)} values; it must have at most {MOST_VALUES}'
        raise ValueError(msg)
    longest = max((len(each) for each in values if isinstance(each, str)), default=0)
    if longest > most_characters:
        msg = f'has a value of {longest} characters; it must have at most {most_characters}'
        raise ValueError(msg)


def _name_setting(value: str) -> str:
    if not value.isprintable():
        raise refusal(value, 'without control characters')
    return value


def refusal(value: object, rule: str) -> ValueError:
    """
    Return the error about a value that is not allowed.

    :param rule: the end of a sentence with "it must be".
    """
    shown = f'"{printable(shortened(value))}"' if isinstance(value, str) else value
    return ValueError(f'is {shown}; it must be {rule}')
