# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Fill the table of elements row by row: read poses and references on the way in."""

from __future__ import annotations

from sdf_pose_bridge.errors import AttributeInvalidError
from sdf_pose_bridge.errors import ElementInvalidError
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.names import scoped_name
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.sdformat.document import boolean_from_text
from sdf_pose_bridge.sdformat.document import Document
from sdf_pose_bridge.sdformat.document import text_of
from sdf_pose_bridge.sdformat.document import WHITE_SPACE
from sdf_pose_bridge.sdformat.document import XmlElement
from sdf_pose_bridge.sdformat.elements import Elements
from sdf_pose_bridge.sdformat.elements import NOWHERE
from sdf_pose_bridge.sdformat.pose_text import pose_from_text
from sdf_pose_bridge.sdformat.pose_text import PoseText
from sdf_pose_bridge.sdformat.pose_text import PoseTextError
from sdf_pose_bridge.sdformat.reading import Reading

_NO_POSE = PoseText('', False, False)


class ElementBuilder(Reading):
    """
    The table while it is being filled.

    :param document: the file that elements are read from at first.
    :param problems: takes what is wrong with names, attributes and values.
    """

    def __init__(self, document: Document, problems: Problems) -> None:
        super().__init__(document, problems)
        self._missing: dict[int, dict[str, str]] = {}

    def elements(self) -> Elements:
        """
        Return the table; poses that cannot be read are reported and stay the identity.

        :return: all elements that were added.
        """
        table, failures = self.columns.elements(self._files, self._missing)
        for index, reason in failures:
            place = table.place(index, int(table.pose_lines[index]), 'pose')
            self._problems.error(ElementInvalidError(reason, place))
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
        poses = list(xml.iterchildren('pose')) if kind > Kind.WORLD else []
        pose_line = poses[0].sourceline or 0 if poses else 0
        file = self._file_of(xml) if self._document.origins else self._file
        index = self.columns.append(
            kind, name, parent, scope, file, xml.sourceline or 0, pose_line)
        for further in poses[1:]:
            self._check_ignored_pose(further, index)
        if poses:
            self.columns.set_pose(index, self._pose(poses[0], index))
        return index

    def first_link_name(self, start: int, holder: int) -> str:
        """
        Name the link that is canonical if nothing else is said.

        :param start: index from which on to look.
        :param holder: index of the model that is looked into.
        :return: the first link's name; else that of the first nested model's, scoped; else empty.
        """
        columns = self.columns
        nested = NOWHERE
        for index in range(start, len(columns)):
            if columns.parent(index) != holder:
                continue
            if columns.kind(index) is Kind.LINK:
                return columns.names[index]
            if columns.kind(index) is Kind.MODEL and nested == NOWHERE:
                nested = index
        if nested == NOWHERE:
            return ''
        inside = columns.models[nested].canonical_link or self.first_link_name(nested + 1, nested)
        name = columns.names[nested]
        return scoped_name(name, inside) if inside else name

    def check_top_pose(self, xml: XmlElement, parent: int) -> None:
        """
        Report a pose at the top of a file that is written relative to something.

        :param xml: a model at the top of its file.
        :param parent: index of the element that holds it.
        """
        pose = next(xml.iterchildren('pose'), None)
        relative_to = '' if pose is None else pose.get('relative_to', '').strip(WHITE_SPACE)
        if pose is not None and relative_to and xml.tag == 'model':
            msg = (f'relative_to="{relative_to}": a model at the top of a file is placed in the '
                   'implicit root, which has no frames')
            part = f'{self.described(xml)}/pose'
            self.error(AttributeInvalidError, pose, msg, parent, part)
            del pose.attrib['relative_to']

    def leave_out(self, parent: int, name: str, uri: str) -> bool:
        """
        Note that something could not be found.

        :param parent: index of the element that would hold it.
        :param name: what it would be called; empty where that cannot be known.
        :param uri: where it should have come from.
        :return: whether this is the first time for the URI.
        """
        is_first = all(uri not in names.values() for names in self._missing.values())
        self._missing.setdefault(parent, {})[name] = uri
        return is_first

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

    def _pose(self, xml: XmlElement, index: int) -> PoseText:
        if not xml.keys():
            return PoseText(text_of(xml), False, False)
        degrees = xml.get('degrees')
        is_degrees = boolean_from_text(degrees) if degrees and degrees.strip() else False
        if is_degrees is None:
            msg = f'degrees="{degrees}" is no boolean; it must be true, false, 1 or 0'
            self.error(AttributeInvalidError, xml, msg, index, 'pose')
        rotation_format = xml.get('rotation_format', '').strip(WHITE_SPACE)
        is_quaternion = rotation_format == 'quat_xyzw'
        if xml.get('frame') is not None:
            msg = f'frame="{xml.get("frame")}" has no meaning since 1.7; relative_to has'
            self.warning(xml, msg, index, 'pose')
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

    def _check_ignored_pose(self, xml: XmlElement, index: int) -> None:
        """Judge a second pose, which counts for nothing but has to be one."""
        is_quaternion = xml.get('rotation_format', '').strip(WHITE_SPACE) == 'quat_xyzw'
        try:
            pose_from_text(PoseText(text_of(xml), is_quaternion, False))
        except PoseTextError as error:
            self._problems.error(
                ElementInvalidError(str(error), self._place(xml, index, 'pose')))

    def _read_relative_to(self, xml: XmlElement, index: int) -> None:
        relative_to = self.reference(xml, 'relative_to', index, 'pose')
        if not relative_to:
            return
        columns = self.columns
        kind = columns.kind(index)
        if kind is Kind.INERTIAL:
            msg = f'relative_to="{relative_to}" is ignored; an inertial is placed in its link'
            self.warning(xml, msg, index, 'pose')
        elif kind is Kind.ACTOR:
            msg = f'relative_to="{relative_to}" is ignored; an actor is placed in the world'
            self.warning(xml, msg, index, 'pose')
        elif kind is Kind.LIGHT and columns.kind(columns.parent(index)) is Kind.ROOT:
            msg = (f'relative_to="{relative_to}" is ignored; a light at the top of a file is '
                   'placed in the implicit root')
            self.warning(xml, msg, index, 'pose')
        else:
            columns.relative_to[index] = relative_to
