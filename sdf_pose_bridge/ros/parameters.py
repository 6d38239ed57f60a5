# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of the node; each one is declared once, as an attribute of :class:`Settings`."""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Iterable
from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import dataclass
from dataclasses import field
from typing import Any
from typing import Generic
from typing import TypeVar

from rcl_interfaces.msg import FloatingPointRange
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.exceptions import InvalidParameterValueException
from rclpy.node import Node
from rclpy.parameter import Parameter

from sdf_pose_bridge.names import hint_from_names
from sdf_pose_bridge.ros.parameter_values import choice_setting
from sdf_pose_bridge.ros.parameter_values import directories_setting
from sdf_pose_bridge.ros.parameter_values import HIGHEST_RATE
from sdf_pose_bridge.ros.parameter_values import hint_about_command_line
from sdf_pose_bridge.ros.parameter_values import kinds_setting
from sdf_pose_bridge.ros.parameter_values import LOWEST_RATE
from sdf_pose_bridge.ros.parameter_values import parameter_with_type
from sdf_pose_bridge.ros.parameter_values import path_setting
from sdf_pose_bridge.ros.parameter_values import patterns_setting
from sdf_pose_bridge.ros.parameter_values import prefix_setting
from sdf_pose_bridge.ros.parameter_values import PUBLISHED_KINDS
from sdf_pose_bridge.ros.parameter_values import rate_setting
from sdf_pose_bridge.ros.parameter_values import root_frame_setting
from sdf_pose_bridge.ros.parameter_values import separator_setting
from sdf_pose_bridge.ros.parameter_values import TYPES
from sdf_pose_bridge.ros.parameter_values import words_about_wrong_type
from sdf_pose_bridge.scene.loading import MissingInclude
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.tree import AnchorModels
from sdf_pose_bridge.tf.tree import DEFAULT_KINDS
from sdf_pose_bridge.tf.tree import TfOptions

Value = str | bool | float | list[str]
Setting = TypeVar('Setting')


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
        return TYPES[type(self.default)]

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, settings: Settings, owner: type) -> Setting:
        setting: Setting = settings.values[self.name]
        return setting


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
    publish_robot_description = Declaration(
        True,
        'Publishes the text of sdf_file, or that of robot_description, on the topic '
        'robot_description, unless it is a world.',
        'true or false',
        bool,
        needs_load=False,
    )
    root_frame = Declaration(
        'world',
        'The TF frame of the SDF world, or of the implicit root of a model file.',
        'not empty, no leading slash, at most 255 characters',
        root_frame_setting,
    )
    anchor_models = Declaration(
        'auto',
        'Which top-level models get a transform from root_frame; odometry or localization can '
        'publish that of the others. "auto" is "static" for a model file or URDF, and "all" for a '
        'world.',
        'one of auto, all, static, none',
        choice_setting(AnchorModels),
    )
    model = Declaration(
        '',
        'Publish only this model of a world; everything if empty.',
        'the name of a model as in SDF: robot, or robot::arm for a nested one',
        str,
    )
    frame_names = Declaration(
        'auto',
        'How frame ids are made: "scoped" keeps the names of all models (robot/arm/tool), '
        '"relative" leaves out that of the top-level model (arm/tool), "auto" is relative for a '
        'model file and scoped for a world.',
        'one of auto, scoped, relative',
        choice_setting(FrameNames),
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
        'Precedes every frame id but that of root_frame, with nothing in between.',
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
    optical_frames = Declaration(
        True,
        'Adds an optical frame (REP 103: z forward, x right, y down) for each camera, named by '
        'its <optical_frame_id>, or like the camera with _optical appended.',
        'true or false',
        bool,
    )
    use_joint_states = Declaration(
        False,
        'Makes moving joints follow the topic joint_states: their transforms are on /tf instead '
        'of /tf_static.',
        'true or false',
        bool,
    )
    resource_paths = Declaration(
        [],
        'Directories searched for model:// and relative URIs before those of '
        'GZ_SIM_RESOURCE_PATH and SDF_PATH.',
        'paths of directories, at most 1000; empty ones are ignored',
        directories_setting,
    )
    publish_rate = Declaration(
        0.0,
        'How often everything is published again, in Hz, for listeners that cannot be latched; '
        '0.0 for once, which is enough for all others. Also the highest rate of /tf.',
        f'0.0 for never, or from {LOWEST_RATE} to {HIGHEST_RATE}',
        rate_setting,
        needs_load=False,
        maximum=HIGHEST_RATE,
    )
    watch = Declaration(
        True,
        'Reads the file again when it, or a file that it includes, has changed.',
        'true or false',
        bool,
        needs_load=False,
    )
    on_missing_include = Declaration(
        'error',
        'What to do about an include that cannot be found: "error" refuses the file, "skip" '
        'leaves the include out with a warning.',
        'one of error, skip',
        choice_setting(MissingInclude),
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
    def source(self) -> str:
        """The name of what is published, for people: that of the file or of the parameter."""
        return self.sdf_file or 'robot_description'

    @property
    def tf_options(self) -> TfOptions:
        """The settings of the TF tree; parameters and options have the same names."""
        return TfOptions(**{name: self.values[name] for name in TfOptions._fields})

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


FREQUENCY = 'publish_frequency'
"""The name of ``publish_rate`` in robot_state_publisher, which is understood at the start."""


def settings_from_node(node: Node) -> Settings:
    """
    Declare all parameters on a node and convert their values.

    :raises SettingsError: if a value has the wrong type or is not allowed.
    """
    values = {}
    sentences = []
    for name, declaration in DECLARATIONS.items():
        try:
            values[name] = declaration.convert(_declared_value(node, declaration))
        except ValueError as error:
            sentences.append(f'parameter {name} {error}')
    return _checked_settings(values, sentences)


def settings_from_values(values: Mapping[str, Any]) -> Settings:
    """
    Convert values of parameters without a node.

    :param values: values by the names of parameters; the others have their defaults.
    :raises SettingsError: if a value has the wrong type or is not allowed.
    """
    defaults = {name: each.convert(each.default) for name, each in DECLARATIONS.items()}
    return changed_settings(
        Settings(defaults), [Parameter(name, value=value) for name, value in values.items()])


def changed_settings(settings: Settings, parameters: Iterable[Parameter]) -> Settings:
    """
    Convert new values of parameters.

    :param parameters: the new values; parameters that are not declared here are ignored.
    :raises SettingsError: if a value has the wrong type or is not allowed.
    """
    values = dict(settings.values)
    sentences = []
    for given in parameters:
        if given.name in DECLARATIONS:
            try:
                values[given.name] = _converted(given, DECLARATIONS[given.name])
            except ValueError as error:
                sentences.append(f'parameter {given.name} {error}')
    return _checked_settings(values, sentences)


def warnings_about_unknown_parameters(node: Node) -> list[str]:
    """Find parameters that were given when the node was started, but that it does not have."""
    return [
        f'parameter {name} is called publish_rate here; its value is taken for that'
        if name == FREQUENCY else
        f'there is no parameter "{name}", so it has no effect{hint_from_names(name, DECLARATIONS)}'
        for name in _given_parameters(node)
        if name not in DECLARATIONS and not node.has_parameter(name)]


def _checked_settings(values: Mapping[str, Any], sentences: Sequence[str]) -> Settings:
    sources = [values.get(name) for name in ('sdf_file', 'robot_description')]
    if all(sources):
        msg = ('parameters sdf_file and robot_description are both set; set one of them, and the '
               'other one to an empty string')
        sentences = [msg, *sentences]
    elif sources == ['', '']:
        msg = ('parameter sdf_file is not set; name the file to publish: --ros-args -p '
               'sdf_file:=cell.sdf after "ros2 run ...", sdf_file:=cell.sdf after "ros2 launch '
               '..."; or set robot_description to its text')
        sentences = [msg, *sentences]
    if sentences:
        raise SettingsError(sentences)
    return Settings(values)


def _given_parameters(node: Node) -> Mapping[str, Parameter]:
    """Return what was given when the node was started, by names."""
    # rclpy shows this in no public way but to declare all of it, with any type and unexplained.
    given: Mapping[str, Parameter] = node._parameter_overrides  # noqa: SLF001
    return given


def _declared_value(node: Node, declaration: Declaration[Any]) -> Any:
    name, type_, value = declaration.name, declaration.type_, declaration.default
    parameters = _given_parameters(node)
    given = parameters.get(name) or (
        parameters.get(FREQUENCY) if name == 'publish_rate' else None)
    if given is not None and given.type_ is not Parameter.Type.NOT_SET:
        given = parameter_with_type(given, type_)
        if given.type_ is not type_:
            msg = words_about_wrong_type(given, type_) + hint_about_command_line(given, type_)
            raise ValueError(msg)
        value = given.value
    elif given is not None and type_ is Parameter.Type.STRING_ARRAY:
        # rclpy reads an empty list on the command line as no value.
        value = []
    descriptor = ParameterDescriptor(
        type=type_.value, description=declaration.description,
        additional_constraints=declaration.constraint, read_only=declaration.is_read_only)
    if declaration.maximum is not None:
        descriptor.floating_point_range = [
            FloatingPointRange(from_value=0.0, to_value=declaration.maximum)]
    try:
        # rclpy cannot tell the type of an empty list.
        node.declare_parameter(
            name, type_ if value == [] else value, descriptor, ignore_override=True)
    except InvalidParameterValueException as error:
        msg = f'must be {declaration.constraint}: {error}'
        raise ValueError(msg) from None
    if value == []:
        node.set_parameters([Parameter(name, type_, value)])
    return value


def _converted(given: Parameter, declaration: Declaration[Any]) -> Any:
    given = parameter_with_type(given, declaration.type_)
    if given.type_ is Parameter.Type.NOT_SET:
        msg = 'cannot be without a value'
        raise ValueError(msg)
    if given.type_ is not declaration.type_:
        raise ValueError(words_about_wrong_type(given, declaration.type_))
    return declaration.convert(given.value)
