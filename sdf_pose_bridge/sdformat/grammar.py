# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The grammar of SDFormat: the allowed and required content of each element, and its values.

Elements with a pose are members of :class:`Kind`, all others are in
:mod:`~sdf_pose_bridge.sdformat.specification`. The content of an element is a list of items,
separated by blanks:

* ``tag``: a child element; its definition is ``parent/tag`` or ``tag``, or it is a string.
* ``tag:type`` or ``tag:type[min,max]``: a child element with a value. The type is one of
  :class:`ValueType`, or of :data:`~sdf_pose_bridge.sdformat.specification.CHOICES`.
* ``tag,tag:type``: several with the same type.
* ``tag=name``: a child element that is defined under another name.
* ``@name`` or ``@name:type``: an attribute.
* ``:type`` or ``!:type``: the type of the value of the element itself.
* ``*``: any children, which are not read.
* ``/`` or ``/name``: the element has a file of its own in the specification, of its tag or of that
  name. So parameters of includes can add and replace it by this name. All kinds have one.

``!`` after a tag or a name: the element or attribute is required. If a required child element is
missing, libsdformat adds it with its default value, except in joints. ``+`` is the same for an
element that may be repeated; its value may be blank, which a required value may not be otherwise.

``^`` comes next: the attribute, or the text of the child element, names a frame around the
element. Merges and conversions, which move the element, change it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
import enum
from functools import cache, cached_property
import math
import re
from typing import Any, NamedTuple

from sdf_pose_bridge.sdformat.specification import Choice, CHOICES, ELEMENTS


class ValueType(enum.Enum):
    """Type of a value: its name in definitions, the rule for values, and the number of numbers."""

    STRING = 'string', 'a text', 0
    BOOLEAN = 'bool', 'a boolean (true, false, 1 or 0)', 0
    INTEGER = 'int', 'an integer', 1
    UNSIGNED = 'uint', 'an integer', 1
    NUMBER = 'double', 'a number', 1
    FLOAT = 'float', 'a number of single precision', 1
    TIME = 'time', 'a time of two integers, seconds and nanoseconds', 2
    TWO_NUMBERS = 'vector2', 'two numbers', 2
    THREE_NUMBERS = 'vector3', 'three numbers', 3
    AXIS = 'axis', 'three numbers', 3
    """A direction: not all of the numbers are zero."""
    COLOR = 'color', 'a color of three or four numbers from 0 to 1', 4
    POSE = 'pose', 'a pose', 6
    FRAME = 'frame', 'a frame that can be named', 0
    """The name of a frame, except the name of the implicit root."""
    CHOICE = 'choice', 'one of a few texts', 0

    def __init__(self, label: str, description: str, count: int) -> None:
        self.label = label
        self.description = description
        self.count = count
        self.is_integer = label in ('int', 'uint', 'time')


class Kind(enum.IntEnum):
    """
    Kind of an element that has a pose.

    Each member has the elements that may contain the kind, the definition of its content, and
    whether references can name elements of the kind. Such elements share a name space in their
    scope. Each other kind has a separate name space among siblings.
    """

    parents: tuple[str, ...]
    content: str
    is_frame: bool

    def __new__(
        cls, parents: Any, content: str = '', is_frame: bool = False,  # noqa: FBT001, FBT002
    ) -> Kind:
        """Make a member. The defaults are for calls that find a member by its value."""
        member = int.__new__(cls, len(cls.__members__))
        member._value_ = len(cls.__members__)
        member.parents = tuple(parents.split())
        member.content = content
        member.is_frame = is_frame
        return member

    ROOT = '', ''
    """The implicit root of a model file, in which its poses are resolved. It has no tag."""
    WORLD = 'sdf', (
        '@name! audio wind include gravity!,magnetic_field!:vector3 atmosphere! gui physics+ '
        'scene! plugin road spherical_coordinates state population')
    MODEL = 'sdf world model', (
        '@name! @canonical_link,@placement_frame:frame pose '
        'static,self_collide,allow_auto_disable,enable_wind:bool plugin gripper include '
        'model_state'), True
    LINK = 'model', (
        '@name! pose gravity,enable_wind,self_collide,kinematic,must_be_base_link:bool '
        'velocity_decay audio_sink audio_source battery'), True
    JOINT = 'model world', (
        '@name! @type!:joint_type pose parent!^ child!^ gearbox_ratio:double '
        'gearbox_reference_body thread_pitch,screw_thread_pitch:double axis axis2 physics'), True
    FRAME = 'model world', '@name! @attached_to^:frame pose', True
    VISUAL = 'link', (
        '@name! pose cast_shadows:bool laser_retro,transparency:double visibility_flags:uint meta '
        'material geometry! plugin')
    COLLISION = 'link', (
        '@name! pose laser_retro:double max_contacts:int density:double auto_inertia_params '
        'geometry! surface')
    SENSOR = 'link joint', (
        '@name! @type!:sensor_type pose always_on:bool update_rate:double visualize:bool topic '
        'enable_metrics:bool frame_id gz_frame_id plugin air_pressure air_speed altimeter camera '
        'contact force_torque gps imu lidar logical_camera magnetometer navsat ray rfid rfidtag '
        'sonar transceiver')
    LIGHT = 'sdf world link', (
        '@name! @type!:light_type pose cast_shadows,light_on,visualize:bool intensity:double '
        'diffuse,specular:color attenuation direction!:vector3 spot')
    INERTIAL = 'link', (
        '@auto:bool pose mass,density:double auto_inertia_params inertia fluid_added_mass')
    PARTICLE_EMITTER = 'link', (
        '@name! @type!:emitter_type pose emitting:bool duration:double size,particle_size:vector3 '
        'lifetime:double rate,min_velocity,max_velocity,scale_rate:double[0,] '
        'color_start,color_end:color color_range_image topic particle_scatter_ratio:float '
        'material')
    PROJECTOR = 'link', (
        '@name! pose texture!:string fov,near_clip,far_clip:double visibility_flags:uint plugin')
    ACTOR = 'sdf world', '@name! pose skin animation script! link!=link joint=joint plugin'

    @property
    def label(self) -> str:
        """Tag of the element: ``particle_emitter``."""
        return self.name.lower()

    @property
    def has_name(self) -> bool:
        """Whether its elements have names; else their label is their name."""
        return '@name!' in self.content


_ITEM = re.compile(
    r'(?P<mark>@(?=\w)|/)?(?P<name>\w+|\*|(?<=/)|(?=[!+]?:))(?P<required>[!+]?)(?P<reference>\^?)'
    r'(?:=(?P<identifier>\w+(?:/\w+)?))?'
    r'(?P<value>:(?P<type>\w+)(?:\[(?P<minimum>[^,\]]*),(?P<maximum>[^,\]]*)\])?)?')
_PLAIN_DECIMAL = r'[+-]?[0-9]{1,50}(?:\.[0-9]{0,50})?'
_PLAIN_NUMBER = rf'{_PLAIN_DECIMAL}(?:[eE][+-]?[0-9]{{1,2}})?'
"""A number that all readers of SDFormat read alike."""
_PLAIN_PART = r'(?:0(?:\.[0-9]{0,50})?|1)'
"""Such a number from 0 to 1."""
_PLAIN_VALUES = {
    ':string': re.compile(r'\w+'),
    ':frame': re.compile(r'[a-z]\w*'),
    ':bool': re.compile('true|false|0|1'),
    ':double': re.compile(_PLAIN_NUMBER),
    ':vector3': re.compile(rf'{_PLAIN_NUMBER}(?:\s+{_PLAIN_NUMBER}){{2}}', re.ASCII),
    # One of the numbers begins with another digit than 0, so the length is not zero.
    ':axis': re.compile(
        rf'(?=(?:.*\s)?[+-]?[1-9]){_PLAIN_DECIMAL}(?:\s+{_PLAIN_DECIMAL}){{2}}', re.ASCII),
    ':color': re.compile(rf'{_PLAIN_PART}(?:\s+{_PLAIN_PART}){{2,3}}', re.ASCII),
}
_NO_VALUE = re.compile('(?!)')
_UNREAD = frozenset({'model_state', 'population', 'road', 'state'})
"""Elements that libsdformat does not load."""
_CHECKED_WITH_FRAMES = frozenset({'include', 'material', 'shader', 'submesh'})
"""Elements without a frame of which libsdformat checks more than values when it loads frames."""
_CONTENTS = {**ELEMENTS, **{kind.label: kind.content for kind in Kind}}
_KINDS = {kind.label: kind for kind in Kind}
_VALUE_TYPES = {each.label: each for each in ValueType} | dict.fromkeys(CHOICES, ValueType.CHOICE)


class Item(NamedTuple):
    """One item of the content of an element: a child element, an attribute or its value."""

    mark: str
    name: str
    """Empty for the value of the element itself."""
    required: str
    """``!``, ``+`` or empty."""
    is_reference: bool
    """Whether it names a frame around the element."""
    identifier: str
    value: str
    """The type and the range, as written; empty for a child element with a definition."""
    value_type: ValueType
    choice: Choice | None
    """The possible values of a choice."""
    minimum: float
    maximum: float
    is_plain: Callable[[str], object]
    """Returns a true value for valid texts of the most frequent forms, so that they need no other
    check."""


@cache
def _items(content: str) -> Sequence[Item]:
    words = (word.partition(':') for word in content.split())
    return [
        _item(f'{name}{colon}{rest}')
        for names, colon, rest in words for name in names.split(',')]


def _item(text: str) -> Item:
    match = _ITEM.fullmatch(text)
    if match is None:
        msg = f'"{text}" is not an item of a definition'
        raise ValueError(msg)
    mark, name, required, reference, identifier, value, label, minimum, maximum = match.groups('')
    if label and label not in _VALUE_TYPES:
        msg = f'"{label}" in the definition "{text}" is not a type of values'
        raise ValueError(msg)
    if identifier and identifier not in _CONTENTS:
        msg = f'"{identifier}" in the definition "{text}" is not the name of a definition'
        raise ValueError(msg)
    return Item(
        mark, name, required, bool(reference), identifier, value, _VALUE_TYPES[label or 'string'],
        CHOICES.get(label), float(minimum or -math.inf), float(maximum or math.inf),
        _PLAIN_VALUES.get(value, _NO_VALUE).fullmatch)


class Definition:
    """
    Definition of an element in its parent element.

    :param identifier: the tag, ``parent/tag`` or another name that tells definitions apart.
    :param content: the content of the element, in the notation of this module.
    :param has_frames: whether kinds of elements are frames here. They are not in elements that
        libsdformat checks but does not load, such as a state.
    :raises ValueError: if the content is not in the notation of this module.
    """

    def __init__(self, identifier: str, content: str, *, has_frames: bool = False) -> None:
        self.identifier = identifier
        self.has_frames = has_frames
        self.kind = _KINDS.get(identifier) if has_frames else None
        """The kind of the element; None for an element that is no frame."""
        items = _items(content)
        self.value = next((item for item in items if not item.name and not item.mark), None)
        """Its value; None for an element with child elements."""
        self.value_type = None if self.value is None else self.value.value_type
        self.is_required = self.value is not None and self.value.required == '!'
        """Whether the value may not be blank."""
        self.is_pose = self.value_type is ValueType.POSE
        self.takes_any_children = any(item.name == '*' for item in items)
        """Whether the element may contain undefined elements."""
        self.attributes = {item.name: item for item in items if item.mark == '@'}
        """The attributes by name."""
        self.checked_attributes = [
            item for item in self.attributes.values()
            if (item.required or item.value_type is not ValueType.STRING)
            and (item.name != 'name' or self.kind is None)]
        """Those that are required or have another type than string, without names of frames."""
        self.has_name = '@name!' in content
        """Whether its elements must have names."""
        self.has_required_attributes = any(item.required for item in self.checked_attributes)
        self._child_items = [
            item for item in items if item.name not in ('', '*') and not item.mark]
        self.required_children = {item.name for item in self._child_items if item.required}
        """Tags of the child elements that libsdformat adds if they are missing."""

    @cached_property
    def children(self) -> Mapping[object, Definition]:
        """The child elements by tag."""
        children: dict[object, Definition] = {
            item.name: self._child(item) for item in self._child_items}
        for kind in Kind:
            if self.identifier in kind.parents:
                children[kind.label] = definition_of(kind.label, has_frames=self.has_frames)
        return children

    @cached_property
    def concerns_frames(self) -> bool:
        """Whether there is something to read in it if all values in it are checked already."""
        return self.has_frames and (
            self.kind is not None or self.is_pose or self.identifier in _CHECKED_WITH_FRAMES
            or any(child.concerns_frames for child in self.children.values()))

    @cached_property
    def references(self) -> Sequence[tuple[str, str]]:
        """
        The references to frames around it, of itself and of elements in it that are no frames.

        Each is the path of an element and an attribute of it; an empty one for its text.
        """
        found = [('.', item.name) for item in self.attributes.values() if item.is_reference]
        for item in self._child_items:
            child = self.children[item.name]
            if item.is_reference:
                found.append((item.name, ''))
            elif child.has_frames and child.kind is None:
                found += [(f'{item.name}/{path}', name) for path, name in child.references]
        return found

    def _child(self, item: Item) -> Definition:
        identifier = next((
            each for each in (item.identifier, f'{self.identifier}/{item.name}', item.name)
            if each in _CONTENTS), '')
        if item.value or not identifier:
            return Definition(item.name, f'{item.required}{item.value or ":string"}')
        return definition_of(identifier, has_frames=self.has_frames and identifier not in _UNREAD)


def definition_of(identifier: str, *, has_frames: bool = False) -> Definition:
    """
    Return the definition of an element, always the same object.

    :param identifier: label of a kind, or a key of :data:`ELEMENTS`.
    :param has_frames: as for :class:`Definition`.
    """
    return _definition(identifier, has_frames=has_frames)


@cache
def _definition(identifier: str, *, has_frames: bool) -> Definition:
    return Definition(identifier, _CONTENTS[identifier], has_frames=has_frames)


STANDALONE_ELEMENTS: Mapping[str, str] = {
    item.name or identifier: identifier
    for identifier, content in _CONTENTS.items() for item in _items(content)
    if item.mark == '/'} | {kind.label: kind.label for kind in Kind}
"""Elements with a file of their own in the specification: identifiers by the names of the files.
This reads all definitions, so that a mistake in one is an error of the import."""

REFERENCE_ATTRIBUTES = sorted({
    item.name for content in _CONTENTS.values() for item in _items(content)
    if item.mark and item.is_reference})
"""The attributes that name frames around their elements."""

PARTS_OF_MODEL: Mapping[object, Definition] = {
    tag: child for tag, child in definition_of('model', has_frames=True).children.items()
    if child.has_frames and child.value is None}
"""The child elements of a model with content, without those that libsdformat does not load."""
