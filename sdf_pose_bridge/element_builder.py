# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Fill the table of elements row by row: judge names, attributes and values on the way in."""

from __future__ import annotations

from sdf_pose_bridge.document import boolean_from_text
from sdf_pose_bridge.document import text_of
from sdf_pose_bridge.document import WHITE_SPACE
from sdf_pose_bridge.document import XmlElement
from sdf_pose_bridge.elements import Element
from sdf_pose_bridge.elements import element_path
from sdf_pose_bridge.elements import Elements
from sdf_pose_bridge.elements import Facts
from sdf_pose_bridge.elements import step
from sdf_pose_bridge.errors import AttributeInvalidError
from sdf_pose_bridge.errors import AttributeMissingError
from sdf_pose_bridge.errors import DuplicateNameError
from sdf_pose_bridge.errors import ElementInvalidError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import ReservedNameError
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.names import FRAME_KINDS
from sdf_pose_bridge.names import is_reserved
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.names import WORLD_FRAME
from sdf_pose_bridge.pose_text import poses_from_texts
from sdf_pose_bridge.pose_text import PoseText
from sdf_pose_bridge.problems import Problems

_NO_POSE = PoseText('', False, False)
_ARTICLE = {Kind.ACTOR: 'an', Kind.INERTIAL: 'an'}


class ElementBuilder:
    """
    The table while it is being filled.

    :param path: the file that elements are read from.
    :param problems: takes what is wrong with names, attributes and values.
    """

    def __init__(self, path: str, problems: Problems) -> None:
        self._problems = problems
        self._files = [path]
        self._file = 0
        self._elements: list[Element] = []
        self._texts: list[PoseText] = []
        self._claims: dict[tuple[int, Kind, str], tuple[Kind, int]] = {}

    def elements(self) -> Elements:
        """
        Return the table; poses that cannot be read are reported and stay the identity.

        :return: all elements that were added.
        """
        poses, failures = poses_from_texts(self._texts)
        table = Elements(self._elements, poses, self._files)
        for index, reason in failures:
            place = table.place(index, self._elements[index].pose_line, 'pose')
            self._problems.error(index, ElementInvalidError(reason, place))
        return table

    def add(self, kind: Kind, xml: XmlElement, name: str, parent: int, scope: int) -> int:
        """
        Add an element and read its pose.

        :param kind: its kind.
        :param xml: where it was read from.
        :param name: its name.
        :param parent: index of the element that holds it; -1 for none.
        :param scope: index of the model, world or root whose names its references use.
        :return: its index.
        """
        index = len(self._elements)
        pose = next(xml.iterchildren('pose'), None) if kind > Kind.WORLD else None
        line = xml.sourceline or 0
        if pose is None:
            self._elements.append(Element(kind, name, parent, scope, self._file, line))
            self._texts.append(_NO_POSE)
            return index
        pose_line = pose.sourceline or 0
        self._elements.append(
            Element(kind, name, parent, scope, self._file, line, '', pose_line))
        if len(pose.attrib):
            self._texts.append(self._pose_with_attributes(pose, index))
        else:
            self._texts.append(PoseText(text_of(pose), False, False))
        return index

    def element(self, index: int) -> Element:
        """
        Return an element as it stands now.

        :param index: its index.
        :return: the element.
        """
        return self._elements[index]

    def forget_relative_to(self, index: int) -> None:
        """
        Place an element in the default frame of its kind, whatever was written.

        :param index: its index.
        """
        self._elements[index] = self._elements[index]._replace(relative_to='')

    def set_facts(self, index: int, facts: Facts) -> None:
        """
        Complete an element with what only its kind has.

        :param index: its index.
        :param facts: the facts of its kind.
        """
        self._elements[index] = self._elements[index]._replace(facts=facts)

    def claimed_name(self, kind: Kind, xml: XmlElement, parent: int) -> str | None:
        """
        Read a name that no other element of its name space may have.

        Links, joints, frames and models of one parent share a name space; each other kind has its
        own.

        :param kind: kind of the element.
        :param xml: the element.
        :param parent: index of the element that holds it; -1 for the file.
        :return: the name, or None if it is missing or taken, which is then reported.
        """
        name = self._name(kind, xml, parent)
        if name is None:
            return None
        key = (parent, Kind.FRAME if kind in FRAME_KINDS else kind, name)
        holder = self._claims.setdefault(key, (kind, len(self._elements)))
        if holder == (kind, len(self._elements)):
            return name
        other, index = holder
        msg = (f'the name "{name}" belongs to {_ARTICLE.get(other, "a")} {other.label} of this '
               f'scope already, in line {self._elements[index].line}')
        self.error(DuplicateNameError, xml, msg, parent, step(kind.label, name))
        return None

    def error(
        self, error_class: type[SdfError], xml: XmlElement, message: str, parent: int, part: str,
    ) -> None:
        """
        Report an error at an XML element.

        :param error_class: its cause.
        :param xml: the XML element, for its line.
        :param message: one sentence.
        :param parent: index of the element that it belongs to; -1 for the file.
        :param part: the path from there on; empty for that element itself.
        """
        self._problems.error(
            len(self._elements) - 1, error_class(message, self._place(xml, parent, part)))

    def warning(self, xml: XmlElement, message: str, parent: int, part: str) -> None:
        """
        Report a warning at an XML element.

        :param xml: the XML element, for its line.
        :param message: one sentence.
        :param parent: index of the element that it belongs to; -1 for the file.
        :param part: the path from there on; empty for that element itself.
        """
        self._problems.warning(
            len(self._elements) - 1, 'WARNING', message, self._place(xml, parent, part))

    def reference(self, xml: XmlElement, attribute: str, index: int, part: str = '') -> str:
        """
        Read an attribute that names a frame.

        :param xml: the XML element that has it.
        :param attribute: its name.
        :param index: index of the element that it belongs to.
        :param part: path of the XML element from there on.
        :return: the name; empty if there is none, or one that may not be written, which is then
            reported.
        """
        name = xml.get(attribute, '').strip(WHITE_SPACE)
        if name == ROOT_FRAME:
            msg = f'{attribute}="{name}": this name is reserved, nothing can refer to it'
            self.error(AttributeInvalidError, xml, msg, index, part)
            return ''
        return name

    def _name(self, kind: Kind, xml: XmlElement, parent: int) -> str | None:
        written = xml.get('name')
        if written is None:
            msg = f'the {kind.label} has no name'
            self.error(AttributeMissingError, xml, msg, parent, kind.label)
            return None
        name = written.strip(WHITE_SPACE)
        if not name:
            msg = f'the name of the {kind.label} is empty'
            self.error(AttributeInvalidError, xml, msg, parent, kind.label)
            return None
        if kind is not Kind.ACTOR and is_reserved(name):
            rule = ('it means the frame of the world' if name == WORLD_FRAME else
                    'so are all that begin and end with two underscores')
            msg = f'the name "{name}" is reserved; {rule}'
            self.error(ReservedNameError, xml, msg, parent, step(kind.label, name))
        return name

    def _pose_with_attributes(self, xml: XmlElement, index: int) -> PoseText:
        degrees = xml.get('degrees')
        is_degrees = False if degrees is None else boolean_from_text(degrees)
        if is_degrees is None:
            msg = f'degrees="{degrees}" is no boolean; it must be true, false, 1 or 0'
            self.error(AttributeInvalidError, xml, msg, index, 'pose')
        rotation_format = xml.get('rotation_format', '').strip(WHITE_SPACE)
        is_quaternion = rotation_format == 'quat_xyzw'
        self._read_relative_to(xml, index)
        if rotation_format and not is_quaternion and rotation_format != 'euler_rpy':
            msg = f'rotation_format="{rotation_format}" must be euler_rpy or quat_xyzw'
            self.error(ElementInvalidError, xml, msg, index, 'pose')
            return _NO_POSE
        if is_quaternion and is_degrees:
            msg = 'degrees="true" cannot go with rotation_format="quat_xyzw"'
            self.error(ElementInvalidError, xml, msg, index, 'pose')
            return _NO_POSE
        return PoseText(text_of(xml), is_quaternion, bool(is_degrees))

    def _read_relative_to(self, xml: XmlElement, index: int) -> None:
        element = self._elements[index]
        relative_to = self.reference(xml, 'relative_to', index, 'pose')
        if relative_to and element.kind is Kind.INERTIAL:
            msg = f'relative_to="{relative_to}" is ignored; an inertial is placed in its link'
            self.warning(xml, msg, index, 'pose')
        elif relative_to and element.kind is Kind.ACTOR:
            msg = f'relative_to="{relative_to}" is ignored; an actor is placed in the world'
            self.warning(xml, msg, index, 'pose')
        elif relative_to:
            self._elements[index] = element._replace(relative_to=relative_to)

    def _place(self, xml: XmlElement, parent: int, part: str) -> Place:
        path = element_path(self._elements, parent)
        return Place(
            self._files[self._file], xml.sourceline or 0, f'{path}/{part}' if part else path)
