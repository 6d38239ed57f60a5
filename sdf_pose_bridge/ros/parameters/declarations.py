# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The parameters of the node and their values.

Each parameter is declared once, as an attribute of :class:`Settings`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
import enum
from fnmatch import translate
import re
from typing import Any, Generic, TypeVar

from rclpy.parameter import Parameter

from sdf_pose_bridge.export.published_scene import DescriptionFormat, LoadRequest
from sdf_pose_bridge.ros.cdr import POSE_TYPES
from sdf_pose_bridge.ros.parameters import rules
from sdf_pose_bridge.sdformat.limits import MissingInclude
from sdf_pose_bridge.tf.anchors import AnchorModels
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.joint_positions import UnreportedJoints
from sdf_pose_bridge.tf.tree import DEFAULT_KINDS, TfOptions

Value = str | bool | float | list[str]
Setting = TypeVar('Setting')
Choice = TypeVar('Choice', bound=enum.Enum)


class SettingsError(ValueError):
    """
    Values of parameters that are not allowed.

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
    """The purpose of the parameter."""
    constraint: str
    """The allowed values."""
    convert: Callable[[Any], Setting]
    """Makes the setting of a value. If the value is not allowed, it raises ValueError with the
    words that follow "parameter <name>" in a sentence."""
    maximum: float | None = None
    """The largest value of a number; the smallest one is 0.0."""
    is_read_only: bool = False
    """Whether the parameter can be set only at the start."""
    most_characters: int = 0
    """Largest length of a text, or of each text of a list."""
    name: str = field(init=False)

    def __post_init__(self) -> None:
        if isinstance(self.default, str | list) != bool(self.most_characters):
            msg = 'a parameter of texts, and no other one, needs most_characters'
            raise TypeError(msg)

    @property
    def type_(self) -> Parameter.Type:
        """The type of its values."""
        # rclpy takes an empty list for one of bytes.
        return (Parameter.Type.STRING_ARRAY if self.default == []
                else Parameter.Type.from_parameter_value(self.default))

    @property
    def rule(self) -> str:
        """The constraint with the limits of texts."""
        if not self.most_characters or self.constraint.startswith('one of'):
            return self.constraint
        each = f'{rules.MOST_VALUES} values of at most ' if isinstance(self.default, list) else ''
        return f'{self.constraint}; at most {each}{self.most_characters} characters'

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, settings: Settings, owner: type) -> Setting:
        setting: Setting = settings.values[self.name]
        return setting


def _switch(default: bool, description: str) -> Declaration[bool]:  # noqa: FBT001
    return Declaration(default, description, 'true or false', bool)


def _choice(default: Choice, description: str) -> Declaration[Choice]:
    """Declare a parameter with the values of an enumeration."""
    known = [choice.value for choice in type(default)]
    rule = f'one of {", ".join(known)}'

    def setting(value: str) -> Choice:
        if value not in known:
            raise rules.refusal(value, rule)
        return type(default)(value)

    return Declaration(
        default.value, description, rule, setting, most_characters=rules.MOST_CHARACTERS)


def _rate(description: str, zero: str, highest: float, default: float = 0.0) -> Declaration[float]:
    """
    Declare a parameter whose values are rates in Hz.

    :param zero: the meaning of 0.0.
    """
    rule = f'0.0 {zero}, or from {rules.LOWEST_RATE} to {highest}'

    def setting(value: float) -> float:
        # NaN is out of any range.
        if value and not rules.LOWEST_RATE <= value <= highest:
            raise rules.refusal(value, rule)
        return value

    return Declaration(default, description, rule, setting, maximum=highest)


class Settings:
    """The settings of the node."""

    def __init__(self, values: Mapping[str, Any]) -> None:
        self.values = values

    sdf_file = Declaration(
        '',
        'The file to publish, of SDFormat or URDF.',
        'the path of a file or of a model directory, or a file://, package:// or model:// URI, '
        'such as package://name/worlds/cell.sdf; either this or robot_description is required',
        str, most_characters=rules.MOST_CHARACTERS_OF_PATH,
    )
    robot_description = Declaration(
        '',
        'The text to publish, of SDFormat or URDF, instead of sdf_file. Relative includes '
        'are searched in resource_paths.',
        'the text of a file; either this or sdf_file is required',
        str, most_characters=rules.MOST_CHARACTERS_OF_FILE,
    )
    publish_robot_description = _switch(
        True,
        'Publishes the text of a model or URDF on the topic robot_description.',
    )
    description_format = _choice(
        DescriptionFormat.AS_GIVEN,
        'Content of the topic robot_description: "as_given" is the unchanged text of a model or '
        'URDF; "urdf" is URDF made of the published model, also of a world. Its links are the '
        'frames on TF, and TF also has frames at its joints.',
    )
    publish_transforms = _switch(True, 'Publishes all transforms one by one on ~/transforms.')
    publish_visuals = _switch(
        True, 'Publishes the shapes of the links on ~/visuals while there is a subscriber.',
    )
    publish_diagnostics = _switch(
        True, 'Publishes the state of the node and the errors of the last load on /diagnostics.',
    )
    root_frame = Declaration(
        'world',
        'The TF frame of the SDF world, or of the implicit root of a model file.',
        'not empty, no leading slash',
        rules.root_frame_setting, most_characters=rules.MOST_CHARACTERS,
    )
    anchor_models = Declaration(
        AnchorModels.AUTO.value,
        'The top-level models that get a transform from root_frame; odometry or localization can '
        'publish the others. "auto" is "static" for a model file or URDF, and "all" for '
        'a world.',
        'auto, all, static, none, or glob patterns of the names of models, separated by '
        'commas, such as table*,fence; static may be one of them',
        rules.anchors_setting, most_characters=rules.MOST_CHARACTERS_OF_PATH,
    )
    model = Declaration(
        '',
        'Publishes only this model of a world; everything if empty.',
        'the name of a model as in SDF: robot, or robot::arm for a nested one',
        str, most_characters=rules.MOST_CHARACTERS_OF_PATH,
    )
    model_name = Declaration(
        '',
        'The name under which the model of a model file or URDF was spawned; it replaces the name '
        'in the file, and with frame_names "auto" precedes frame ids as in messages of Gazebo.',
        'the name of a model; that of the file if empty',
        rules.model_name_setting, most_characters=rules.MOST_CHARACTERS,
    )
    frame_names = _choice(
        FrameNames.AUTO,
        'Names of models in frame ids: "scoped" keeps the names of all models (robot/arm/tool), '
        '"relative" leaves out the top-level model (arm/tool), "auto" is relative for a '
        'model file in which no frame has the name of the model, else scoped.',
    )
    frame_separator = Declaration(
        '/',
        'Replaces "::" in frame ids. ros_gz_bridge uses "/". To keep "::", quote it twice on the '
        'command line: -p "frame_separator:=\'::\'".',
        'not empty',
        rules.separator_setting, most_characters=rules.MOST_CHARACTERS_OF_SEPARATOR,
    )
    frame_prefix = Declaration(
        '',
        'Precedes every frame id except root_frame, without a separator; also the link "world" of '
        'a URDF.',
        'a leading slash is left out, as by tf2',
        rules.prefix_setting, most_characters=rules.MOST_CHARACTERS,
    )
    kinds = Declaration(
        [name for name, kind in rules.PUBLISHED_KINDS.items() if kind in DEFAULT_KINDS],
        'The kinds of elements that become frames; "auto" is link for URDF, and model, link, '
        'frame and sensor for SDFormat.',
        f'{rules.AUTO_KINDS}, or some of {", ".join(rules.PUBLISHED_KINDS)}',
        rules.kinds_setting, most_characters=rules.MOST_CHARACTERS,
    )
    pose_frame = Declaration(
        '',
        'The frame in which the poses on ~/poses/... are given.',
        'the frame id of a published frame, or of root_frame; root_frame if empty',
        str, most_characters=rules.MOST_CHARACTERS_OF_PATH,
    )
    pose_topics = Declaration(
        ['*'],
        'The frames that get a topic ~/poses/<frame> with their pose in pose_frame.',
        'glob patterns for frame ids, such as robot/* (which matches robot/arm/tool too); '
        f'none if empty; * alone means none if there are more than {rules.MOST_TOPICS} frames, ?* '
        'means all',
        tuple, most_characters=rules.MOST_CHARACTERS,
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
    joint_states_topics = Declaration(
        [*TfOptions().joint_states_topics],
        'Topics of joint states, with use_joint_states. {model} stands for each top-level model '
        'of a world that has moving joints, and messages on its topic name joints of this model '
        'alone; {world} stands for the world.',
        'names of topics, such as joint_states or /world/{world}/model/{model}/joint_state; those '
        'with {model} or {world} count only for a world',
        rules.topic_patterns_setting, most_characters=rules.MOST_CHARACTERS,
    )
    model_pose_topics = Declaration(
        [],
        'Topics of poses of models that move, with messages of '
        f'{", ".join(each.rpartition("/")[2] for each in POSE_TYPES)}. {{model}} stands for each '
        'model; TFMessage names models in its child frame ids. A pose is that of the model frame, '
        'or of the frame in the model that the child frame id names. {world} stands for the '
        'world. If all topics are of plugins in the file, other models do not move.',
        'names of topics, such as /vrpn_mocap/{model}/pose',
        rules.optional_topic_patterns_setting, most_characters=rules.MOST_CHARACTERS,
    )
    model_pose_frames = Declaration(
        [],
        'Frames in the headers of these messages that are the same as root_frame. Those of the '
        'odometry that plugins of Gazebo in the file send are known without it.',
        'glob patterns for frame ids, such as */odom',
        # Compiled here, as look-ups wait for the thread that uses them.
        lambda values: [re.compile(translate(each)) for each in values],
        most_characters=rules.MOST_CHARACTERS,
    )
    model_pose_placement = Declaration(
        '',
        'The frame in each model that poses on these topics are of, such as the markers of a '
        'tracker.',
        'the name of a frame in the model, such as markers or arm::tool; the model frame if '
        'empty, and for models without this frame',
        str, most_characters=rules.MOST_CHARACTERS_OF_PATH,
    )
    simulator = Declaration(
        '',
        'The node of a simulator that is asked for the poses of models, by its service '
        'get_entities_states of the package simulation_interfaces.',
        'the name of a node, such as /gzserver, or of its service, or /; none if empty',
        rules.simulator_setting, most_characters=rules.MOST_CHARACTERS,
    )
    simulator_entity = Declaration(
        rules.MODEL_FIELD, 'The name in the simulator of the model that is {model} in the file.',
        'the name of an entity, such as /World/{model}, with {model} at most once',
        rules.entity_setting, most_characters=rules.MOST_CHARACTERS,
    )
    simulator_others = _switch(
        False, 'Publishes frames of entities of the simulator that the file does not have.',
    )
    simulator_rate = _rate(
        'Most calls of the simulator in a second; 0.0 for none.', 'for none', rules.HIGHEST_RATE,
        default=20.0,
    )
    unreported_joints = _choice(
        UnreportedJoints.NONE,
        'For joints and models that no message has reported: with "none", the frames that they '
        'move are not published; with "zero", they are where the file puts them.',
    )
    resource_paths = Declaration(
        [],
        'Directories searched for model:// and relative URIs, before '
        'GZ_SIM_RESOURCE_PATH and SDF_PATH.',
        'paths of directories; empty ones are ignored',
        rules.directories_setting, most_characters=rules.MOST_CHARACTERS_OF_PATH,
    )
    publish_frequency = _rate(
        'Highest rate in Hz at which a transform that joints move is published on /tf; 0.0 for '
        'each message on joint_states.',
        'for each message', rules.HIGHEST_FREQUENCY,
    )
    ignore_timestamp = _switch(
        False,
        'Publishes for each message on joint_states, even if it has the stamp of the last one, '
        'and independently of publish_frequency.',
    )
    publish_rate = _rate(
        'Rate in Hz at which the transforms that joints do not move are published again, for '
        'listeners that cannot use latched topics; 0.0 to publish them once.',
        'for never', rules.HIGHEST_RATE,
    )
    watch = _switch(True, 'Reads the file again when it, or a file that it includes, has changed.')
    on_missing_include = _choice(
        MissingInclude.ERROR,
        'Treatment of an include that is not found: "error" rejects the file, "skip" leaves the '
        'include out with a warning.',
    )

    allow_set_pose = Declaration(
        False,
        'Offers the service ~/set_pose, which writes a measured pose into the file that places a '
        'frame. Anybody in the domain may call it.',
        'true or false; can be set only at the start',
        bool,
        is_read_only=True,
    )

    @property
    def tf_options(self) -> TfOptions:
        """The settings of the TF tree; parameters and options have the same names."""
        values = {name: value for name, value in self.values.items() if name in TfOptions._fields}
        if self.model_name and self.frame_names is FrameNames.AUTO:
            values['frame_names'] = FrameNames.SCOPED
        if self.simulator:
            del values['model_pose_topics']  # all models follow it
        return TfOptions(
            **values,
            follows_models=bool(self.model_pose_topics or self.simulator),
            has_joint_links=self.description_format is DescriptionFormat.URDF)

    @property
    def load_request(self) -> LoadRequest:
        """The request for a load; parameters and its fields have the same names."""
        names = {*LoadRequest._fields} - {'tf_options'}
        return LoadRequest(
            tf_options=self.tf_options, **{name: self.values[name] for name in names})


DECLARATIONS: dict[str, Declaration[Any]] = {
    name: each for name, each in vars(Settings).items() if isinstance(each, Declaration)}
"""All parameters by their names, in the order of the documentation."""
