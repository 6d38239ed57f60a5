# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The parameters of the node, and the values that they can have.

Each parameter is declared once, as an attribute of :class:`Settings`. A function
``<rule>_setting`` makes the setting of a value. If the value is not allowed, it raises ValueError
with the words that follow "parameter <name>" in a sentence.
"""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import dataclass
from dataclasses import field
import enum
from pathlib import Path
from typing import Any
from typing import Generic
from typing import TypeVar

from rclpy.parameter import Parameter

from sdf_pose_bridge.names import printable
from sdf_pose_bridge.names import shortened
from sdf_pose_bridge.scene.loading import MissingInclude
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.joint_positions import UnreportedJoints
from sdf_pose_bridge.tf.loaded_scene import LoadRequest
from sdf_pose_bridge.tf.tree import AnchorModels
from sdf_pose_bridge.tf.tree import DEFAULT_KINDS
from sdf_pose_bridge.tf.tree import TfOptions

Value = str | bool | float | list[str]
Setting = TypeVar('Setting')
Choice = TypeVar('Choice', bound=enum.Enum)

PUBLISHED_KINDS = {
    kind.label: kind for kind in Kind if kind not in (Kind.ROOT, Kind.WORLD, Kind.ACTOR)}
"""The kinds of element that can become frames, by their names."""

LOWEST_RATE = 0.001
"""The lowest rate in Hz that a parameter can have, but for 0.0."""

HIGHEST_RATE = 100.0
"""The limit of ``publish_rate`` in Hz."""

HIGHEST_FREQUENCY = 1000.0
"""The limit of ``publish_frequency`` in Hz, as in robot_state_publisher."""

MOST_VALUES = 1000
"""How many patterns or directories a parameter may have. Each pattern is compared with each frame,
and each directory is looked into for each include."""

MOST_CHARACTERS = 255
"""How long a name or a pattern may be; a prefix is a part of every frame id."""

MOST_CHARACTERS_OF_PATH = 4096
"""How long a path may be, as in Linux."""

MOST_CHARACTERS_OF_SEPARATOR = 8
"""How long a separator may be, which stands many times in a frame id."""


class SettingsError(ValueError):
    """
    Values that parameters cannot have.

    :param sentences: one for each value, with the parameter, the value and the rule.
    """

    def __init__(self, sentences: Sequence[str]) -> None:
        super().__init__('\n'.join(sentences))
        self.sentences = tuple(sentences)


@dataclass(eq=False)
class Declaration(Generic[Setting]):
    """The declaration of a parameter; as an attribute of :class:`Settings`, its setting."""

    default: Value
    """The default value, which also gives the type."""
    description: str
    """What the parameter is for."""
    constraint: str
    """The values that it can have."""
    convert: Callable[[Any], Setting]
    """Makes the setting of a value. If the value is not allowed, it raises ValueError with the
    words that follow "parameter <name>" in a sentence."""
    needs_load: bool = True
    """Whether a new setting takes effect only when the file is read again."""
    maximum: float | None = None
    """The largest value of a number; the smallest one is 0.0."""
    is_read_only: bool = False
    """Whether the parameter can be set only at the start."""
    name: str = field(init=False)

    @property
    def type_(self) -> Parameter.Type:
        """The type of its values."""
        # rclpy takes an empty list for one of bytes.
        return (Parameter.Type.STRING_ARRAY if self.default == []
                else Parameter.Type.from_parameter_value(self.default))

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, settings: Settings, owner: type) -> Setting:
        setting: Setting = settings.values[self.name]
        return setting


def root_frame_setting(value: str) -> str:
    """Refuse what cannot be the frame id of the root."""
    if not value:
        raise _refusal(value, 'a frame id, which is not empty')
    return prefix_setting(value)


def prefix_setting(value: str) -> str:
    """Refuse what frame ids cannot begin with."""
    if value.startswith('/'):
        raise _refusal(value, 'without a leading slash, which TF does not allow')
    return _name_setting(value, MOST_CHARACTERS)


def separator_setting(value: str) -> str:
    """Refuse what cannot separate the parts of frame ids."""
    if not value:
        raise _refusal(value, 'at least one character, or names run together')
    return _name_setting(value, MOST_CHARACTERS_OF_SEPARATOR)


def kinds_setting(values: Sequence[str]) -> frozenset[Kind]:
    """Make kinds of element of their names."""
    known = ', '.join(PUBLISHED_KINDS)
    if not values:
        raise _refusal([], f'at least one of {known}')
    for value in values:
        if value not in PUBLISHED_KINDS:
            raise _refusal(value, f'made of {known}')
    return frozenset(PUBLISHED_KINDS[value] for value in values)


def patterns_setting(values: Sequence[str]) -> tuple[str, ...]:
    """Refuse too many patterns, and long ones."""
    _check_count(values, 'patterns')
    for value in values:
        _check_length(value, MOST_CHARACTERS)
    return tuple(values)


def path_setting(value: str) -> str:
    """Refuse what is too long for a path."""
    _check_length(value, MOST_CHARACTERS_OF_PATH)
    return value


def directories_setting(values: Sequence[str]) -> tuple[Path, ...]:
    """Make paths, without those that are empty; refuse too many, and long ones."""
    _check_count(values, 'directories')
    return tuple(Path(path_setting(value)).expanduser() for value in values if value)


def _check_count(values: Sequence[str], what: str) -> None:
    if len(values) > MOST_VALUES:
        msg = f'has {len(values)} {what}; it must have at most {MOST_VALUES}'
        raise ValueError(msg)


def _check_length(value: str, most: int) -> None:
    if len(value) > most:
        msg = f'has a value of {len(value)} characters; it must have at most {most}'
        raise ValueError(msg)


def _name_setting(value: str, most: int) -> str:
    _check_length(value, most)
    if not value.isprintable():
        raise _refusal(value, 'without control characters')
    return value


def _refusal(value: object, rule: str) -> ValueError:
    shown = f'"{printable(shortened(value))}"' if isinstance(value, str) else value
    return ValueError(f'is {shown}; it must be {rule}')


def _switch(
    default: bool, description: str, *, needs_load: bool = True,  # noqa: FBT001
) -> Declaration[bool]:
    return Declaration(default, description, 'true or false', bool, needs_load)


def _choice(default: Choice, description: str) -> Declaration[Choice]:
    """Declare a parameter whose values are those of an enumeration."""
    known = [choice.value for choice in type(default)]
    rule = f'one of {", ".join(known)}'

    def setting(value: str) -> Choice:
        if value not in known:
            raise _refusal(value, rule)
        return type(default)(value)

    return Declaration(default.value, description, rule, setting)


def _rate(
    description: str, zero: str, highest: float, *, default: float = 0.0,
) -> Declaration[float]:
    """
    Declare a parameter whose values are rates in Hz.

    :param zero: what 0.0 is for.
    """
    rule = f'0.0 {zero}, or from {LOWEST_RATE} to {highest}'

    def setting(value: float) -> float:
        # What is not a number is out of any range.
        if value and not LOWEST_RATE <= value <= highest:
            raise _refusal(value, rule)
        return value

    return Declaration(
        default, description, rule, setting, needs_load=False, maximum=highest)


class Settings:
    """The settings of the node."""

    def __init__(self, values: Mapping[str, Any]) -> None:
        self.values = values

    sdf_file = Declaration(
        '',
        'The file to publish, of SDFormat or URDF.',
        'the path of a file or of a model directory, or a file://, package:// or model:// URI, '
        'such as package://name/worlds/cell.sdf; either this or robot_description is required',
        path_setting,
    )
    robot_description = Declaration(
        '',
        'The text to publish, of SDFormat or URDF, instead of that of sdf_file. Relative includes '
        'are searched in resource_paths.',
        'the text of a file; either this or sdf_file is required',
        str,
    )
    publish_robot_description = _switch(
        True,
        'Publishes the text of sdf_file, or that of robot_description, on the topic '
        'robot_description, unless it is a world.',
        needs_load=False,
    )
    root_frame = Declaration(
        'world',
        'The TF frame of the SDF world, or of the implicit root of a model file.',
        'not empty, no leading slash, at most 255 characters',
        root_frame_setting,
    )
    anchor_models = _choice(
        AnchorModels.AUTO,
        'Which top-level models get a transform from root_frame; odometry or localization can '
        'publish that of the others. "auto" is "static" for a model file or URDF, and "all" for a '
        'world.',
    )
    model = Declaration(
        '',
        'Publish only this model of a world; everything if empty.',
        'the name of a model as in SDF: robot, or robot::arm for a nested one',
        str,
    )
    frame_names = _choice(
        FrameNames.AUTO,
        'How frame ids are made: "scoped" keeps the names of all models (robot/arm/tool), '
        '"relative" leaves out that of the top-level model (arm/tool), "auto" is relative for a '
        'model file and scoped for a world.',
    )
    frame_separator = Declaration(
        '/',
        'Replaces "::" in frame ids. ros_gz_bridge uses "/". To keep "::", quote it twice on the '
        'command line: -p "frame_separator:=\'::\'".',
        'not empty, at most 8 characters',
        separator_setting,
    )
    frame_prefix = Declaration(
        '',
        'Precedes every frame id but that of root_frame, with nothing in between; also that of '
        'the link "world" of a URDF.',
        'no leading slash, at most 255 characters',
        prefix_setting,
    )
    kinds = Declaration(
        [name for name, kind in PUBLISHED_KINDS.items() if kind in DEFAULT_KINDS],
        'Which kinds of element become frames.',
        f'some of {", ".join(PUBLISHED_KINDS)}',
        kinds_setting,
    )
    pose_frame = Declaration(
        '',
        'The frame in which the poses on ~/poses/... are given.',
        'the frame id of a published frame, or of root_frame; root_frame if empty',
        str,
    )
    pose_topics = Declaration(
        ['*'],
        'Which frames get a topic ~/poses/<frame> with their pose in pose_frame.',
        'glob patterns for frame ids, such as robot/* (which matches robot/arm/tool too); '
        'none if empty; at most 1000 of them, of at most 255 characters; * alone means none '
        'where there are more than 1000 frames, ?* means all',
        patterns_setting,
        needs_load=False,
    )
    optical_frames = _switch(
        True,
        'Adds an optical frame (REP 103: z forward, x right, y down) for each camera, named by '
        'its <optical_frame_id>, or like the camera with _optical appended.',
    )
    use_joint_states = _switch(
        False,
        'Makes moving joints follow the topic joint_states: their transforms are on /tf instead '
        'of /tf_static.',
    )
    unreported_joints = _choice(
        UnreportedJoints.NONE,
        'Where joints are that no message on joint_states has named: with "none" the frames that '
        'they move are not published, with "zero" they are where the file puts them.',
    )
    resource_paths = Declaration(
        [],
        'Directories searched for model:// and relative URIs before those of '
        'GZ_SIM_RESOURCE_PATH and SDF_PATH.',
        'paths of directories, at most 1000; empty ones are ignored',
        directories_setting,
    )
    publish_frequency = _rate(
        'How often a transform that joints move is published on /tf at most, in Hz; 0.0 for each '
        'message on joint_states.',
        'for each message', HIGHEST_FREQUENCY,
    )
    publish_rate = _rate(
        'How often everything that joints do not move is published again, in Hz, for listeners '
        'that cannot be latched; 0.0 for once, which is enough for all others.',
        'for never', HIGHEST_RATE,
    )
    watch = _switch(
        True,
        'Reads the file again when it, or a file that it includes, has changed.',
        needs_load=False,
    )
    on_missing_include = _choice(
        MissingInclude.ERROR,
        'What to do about an include that cannot be found: "error" refuses the file, "skip" '
        'leaves the include out with a warning.',
    )

    allow_set_pose = Declaration(
        False,
        'Offers the service ~/set_pose, which writes a measured pose into the file that places a '
        'frame. Anybody in the domain may call it.',
        'true or false; can be set only at the start',
        bool,
        needs_load=False,
        is_read_only=True,
    )

    @property
    def tf_options(self) -> TfOptions:
        """The settings of the TF tree; parameters and options have the same names."""
        return TfOptions(**{name: self.values[name] for name in TfOptions._fields})

    @property
    def load_request(self) -> LoadRequest:
        """What is read with these settings."""
        return LoadRequest(
            self.sdf_file, self.robot_description, self.resource_paths, self.on_missing_include,
            self.tf_options, self.unreported_joints)

    def needs_load_after(self, before: Settings) -> bool:
        """
        Return whether the file has to be read again.

        :param before: the settings when it was last read.
        :return: True if a setting has changed that takes effect when the file is read.
        """
        return any(
            declaration.needs_load and self.values[name] != before.values[name]
            for name, declaration in DECLARATIONS.items())


DECLARATIONS: dict[str, Declaration[Any]] = {
    name: each for name, each in vars(Settings).items() if isinstance(each, Declaration)}
"""All parameters by their names, in the order in which they are explained to people."""
