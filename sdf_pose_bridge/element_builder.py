# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Fill the table of elements row by row: judge names, attributes and values on the way in."""

from __future__ import annotations

from collections.abc import Iterator
import contextlib
import itertools

from lxml import etree

from sdf_pose_bridge.document import boolean_from_text
from sdf_pose_bridge.document import Document
from sdf_pose_bridge.document import is_data
from sdf_pose_bridge.document import text_of
from sdf_pose_bridge.document import WHITE_SPACE
from sdf_pose_bridge.document import XmlElement
from sdf_pose_bridge.elements import Element
from sdf_pose_bridge.elements import element_path
from sdf_pose_bridge.elements import Elements
from sdf_pose_bridge.elements import Facts
from sdf_pose_bridge.elements import ModelFacts
from sdf_pose_bridge.elements import NOWHERE
from sdf_pose_bridge.elements import step
from sdf_pose_bridge.errors import AttributeInvalidError
from sdf_pose_bridge.errors import AttributeMissingError
from sdf_pose_bridge.errors import DuplicateNameError
from sdf_pose_bridge.errors import ElementInvalidError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import ReservedNameError
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.inclusions import DEEPEST
from sdf_pose_bridge.names import FRAME_KINDS
from sdf_pose_bridge.names import is_reserved
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.names import scoped_name
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.names import WORLD_FRAME
from sdf_pose_bridge.pose_text import pose_from_text
from sdf_pose_bridge.pose_text import poses_from_texts
from sdf_pose_bridge.pose_text import PoseText
from sdf_pose_bridge.pose_text import PoseTextError
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.versions import may_hold_flat_names
from sdf_pose_bridge.versions import renames_clashes
from sdf_pose_bridge.versions import version_of

_NO_POSE = PoseText('', False, False)
_PROXY = '_merged__'
_NAMES_WITH_SEPARATOR = etree.XPath('//*[contains(@name, "::")]')
_ARTICLE = {Kind.ACTOR: 'an', Kind.INERTIAL: 'an'}


class ElementBuilder:
    """
    The table while it is being filled.

    :param document: the file that elements are read from at first.
    :param problems: takes what is wrong with names, attributes and values.
    """

    def __init__(self, document: Document, problems: Problems) -> None:
        self._problems = problems
        self._files = [document.path]
        self._versions = [version_of(document)]
        self._file = 0
        self._elements: list[Element] = []
        self._open_files = [0]
        self._missing: dict[int, dict[str, str]] = {}
        self._texts: list[PoseText] = []
        self._claims: dict[tuple[int, Kind, str], tuple[Kind, int]] = {}

    def elements(self) -> Elements:
        """
        Return the table; poses that cannot be read are reported and stay the identity.

        :return: all elements that were added.
        """
        poses, failures = poses_from_texts(self._texts)
        table = Elements(self._elements, poses, self._files, self._missing)
        for index, reason in failures:
            place = table.place(index, self._elements[index].pose_line, 'pose')
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
        index = len(self._elements)
        poses = xml.iterchildren('pose') if kind > Kind.WORLD else iter(())
        pose = next(poses, None)
        line = xml.sourceline or 0
        if pose is None:
            self._elements.append(Element(kind, name, parent, scope, self._file, line))
            self._texts.append(_NO_POSE)
            return index
        pose_line = pose.sourceline or 0
        self._elements.append(
            Element(kind, name, parent, scope, self._file, line, '', pose_line))
        for further in poses:
            self._check_ignored_pose(further, index)
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

    def set_relative_to(self, index: int, name: str) -> None:
        """
        Place an element in another frame than what was written.

        :param index: its index.
        :param name: the frame, as a reference in its scope; empty for the default of its kind.
        """
        self._elements[index] = self._elements[index]._replace(relative_to=name)

    def set_facts(self, index: int, facts: Facts) -> None:
        """
        Complete an element with what only its kind has.

        :param index: its index.
        :param facts: the facts of its kind.
        """
        self._elements[index] = self._elements[index]._replace(facts=facts)

    @contextlib.contextmanager
    def reading(self, document: Document) -> Iterator[None]:
        """
        Read from another file for a while.

        :param document: the file.
        """
        before = self._file
        if len(self._open_files) >= DEEPEST:
            msg = f'files and models are nested more than {DEEPEST} deep'
            raise ElementInvalidError(msg, Place(document.path))
        self._file = self._file_index(document)
        self._open_files.append(self._file)
        self.check_separators(document)
        try:
            yield
        finally:
            self._file = before
            self._open_files.pop()

    def check_separators(self, document: Document) -> None:
        """
        Report names that hold ``::``, which only old files may have.

        :param document: the file; an old one is judged by the newest that includes it.
        """
        if all(may_hold_flat_names(self._versions[file]) for file in self._open_files):
            return
        found: list[XmlElement] = _NAMES_WITH_SEPARATOR(document.root)
        for xml in found:
            if is_data(xml):
                msg = f'the name "{xml.get("name")}" holds "{SEPARATOR}", which sets scopes apart'
                steps = [str(e.tag) for e in (xml, *xml.iterancestors())]
                self.error(ReservedNameError, xml, msg, NOWHERE, '/'.join(steps[-2::-1]))

    def claimed_name(
        self, kind: Kind, xml: XmlElement, parent: int, name: str = '',
    ) -> str | None:
        """
        Read a name that no other element of its name space may have.

        Links, joints, frames and models of one parent share a name space; each other kind has its
        own. In old files one that clashes with another kind's gets a new name instead.

        :param kind: kind of the element.
        :param xml: the element.
        :param parent: index of the element that holds it; -1 for the file.
        :param name: the name to give it; empty for the one that it has.
        :return: the name, or None if it is missing or taken, which is then reported.
        """
        judged = self._judged_name(kind, xml, parent, name)
        if judged is None:
            return None
        space = Kind.FRAME if kind in FRAME_KINDS else kind
        key = (parent, space, judged)
        if key not in self._claims:
            self._claims[key] = (kind, len(self._elements))
            return judged
        other, index = self._claims[key]
        if other is not kind and self._renames_clashes(kind, parent):
            return self._renamed(kind, xml, parent, judged)
        msg = (f'the name "{judged}" belongs to {_ARTICLE.get(other, "a")} {other.label} of this '
               f'scope already, {self._place_of_claim(index)}')
        self.error(DuplicateNameError, xml, msg, parent, step(kind.label, judged))
        return None

    def first_link_name(self, start: int, holder: int) -> str:
        """
        Name the link that is canonical if nothing else is said.

        :param start: index from which on to look.
        :param holder: index of the model that is looked into.
        :return: the first link's name; else that of the first nested model's, scoped; else empty.
        """
        nested: tuple[int, str] | None = None
        for index in range(start, len(self._elements)):
            element = self._elements[index]
            if element.parent != holder:
                continue
            if element.kind is Kind.LINK:
                return element.name
            if element.kind is Kind.MODEL and nested is None:
                nested = (index, element.name)
        if nested is None:
            return ''
        facts = self._elements[nested[0]].facts
        chosen = facts.canonical_link if isinstance(facts, ModelFacts) else ''
        inside = chosen or self.first_link_name(nested[0] + 1, nested[0])
        return scoped_name(nested[1], inside) if inside else nested[1]

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

    @staticmethod
    def described(xml: XmlElement) -> str:
        """
        Return the step of an element's path that leads to it.

        :param xml: the element.
        :return: such as ``link[@name="l"]``.
        """
        return step(str(xml.tag), xml.get('name', '').strip(WHITE_SPACE))

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

    def note_error(self, error: SdfError) -> None:
        """
        Report an error that was found before.

        :param error: the error, with its place.
        """
        self._problems.error(error)

    def note_warning(self, warning: SdfWarning) -> None:
        """
        Report a warning that was found before.

        :param warning: the warning, with its place.
        """
        self._problems.warning(*warning)

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
        self._problems.error(error_class(message, self._place(xml, parent, part)))

    def warning(self, xml: XmlElement, message: str, parent: int, part: str) -> None:
        """
        Report a warning at an XML element.

        :param xml: the XML element, for its line.
        :param message: one sentence.
        :param parent: index of the element that it belongs to; -1 for the file.
        :param part: the path from there on; empty for that element itself.
        """
        self._problems.warning('WARNING', message, self._place(xml, parent, part))

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

    def _file_index(self, document: Document) -> int:
        for index, path in enumerate(self._files):
            if path == document.path:
                return index
        self._files.append(document.path)
        self._versions.append(version_of(document))
        return len(self._files) - 1

    def _renames_clashes(self, kind: Kind, parent: int) -> bool:
        if parent < 0 or kind not in FRAME_KINDS or kind is Kind.MODEL:
            return False
        holder = self._elements[parent]
        return renames_clashes(self._versions[holder.file]) and (
            holder.kind is Kind.MODEL or kind is Kind.FRAME)

    def _renamed(self, kind: Kind, xml: XmlElement, parent: int, name: str) -> str:
        tries = itertools.chain(
            [f'{name}_{kind.label}'], (f'{name}_{kind.label}{i}' for i in itertools.count()))
        new_name = next(
            new_name for new_name in tries if (parent, Kind.FRAME, new_name) not in self._claims)
        self._claims[parent, Kind.FRAME, new_name] = (kind, len(self._elements))
        msg = (f'the name "{name}" is that of another kind of element in this scope; this '
               f'{kind.label} is called "{new_name}" instead, and references to "{name}" mean the '
               'other one')
        self.warning(xml, msg, parent, step(kind.label, name))
        return new_name

    def _place_of_claim(self, index: int) -> str:
        if index >= len(self._elements):
            return 'which is not valid itself'
        element = self._elements[index]
        return f'see {Place(self._files[element.file], element.line)}'

    def _judged_name(
        self, kind: Kind, xml: XmlElement, parent: int, given: str,
    ) -> str | None:
        written = given or xml.get('name')
        if written is None:
            msg = f'the {kind.label} has no name'
            self.error(AttributeMissingError, xml, msg, parent, kind.label)
            return None
        name = written.strip(WHITE_SPACE)
        if not name:
            msg = f'the name of the {kind.label} is empty'
            self.error(AttributeInvalidError, xml, msg, parent, kind.label)
            return None
        if kind is not Kind.ACTOR and is_reserved(name) and not name.startswith(_PROXY):
            rule = ('it means the frame of the world' if name == WORLD_FRAME else
                    'so are all that begin and end with two underscores')
            msg = f'the name "{name}" is reserved; {rule}'
            self.error(ReservedNameError, xml, msg, parent, step(kind.label, name))
        return name

    def _pose_with_attributes(self, xml: XmlElement, index: int) -> PoseText:
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
        element = self._elements[index]
        relative_to = self.reference(xml, 'relative_to', index, 'pose')
        if relative_to and element.kind is Kind.INERTIAL:
            msg = f'relative_to="{relative_to}" is ignored; an inertial is placed in its link'
            self.warning(xml, msg, index, 'pose')
        elif relative_to and element.kind is Kind.ACTOR:
            msg = f'relative_to="{relative_to}" is ignored; an actor is placed in the world'
            self.warning(xml, msg, index, 'pose')
        elif relative_to and element.kind is Kind.LIGHT and element.parent == element.scope and (
                self._elements[element.scope].kind is Kind.ROOT):
            msg = (f'relative_to="{relative_to}" is ignored; a light at the top of a file is '
                   'placed in the implicit root')
            self.warning(xml, msg, index, 'pose')
        elif relative_to:
            self._elements[index] = element._replace(relative_to=relative_to)

    def _place(self, xml: XmlElement, parent: int, part: str) -> Place:
        path = element_path(self._elements, parent)
        return Place(
            self._files[self._file], xml.sourceline or 0, f'{path}/{part}' if part else path)
