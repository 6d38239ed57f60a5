# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Fill the table of elements in one walk over a tree.

Every element is visited once. By the grammar, an element with a frame becomes a row of the table,
a value is checked, and an unknown element is skipped.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

from lxml import etree

from sdf_pose_bridge.errors import (
    AttributeInvalidError,
    AttributeMissingError,
    DuplicateNameError,
    ElementIncorrectTypeError,
    ElementInvalidError,
    SdfError,
)
from sdf_pose_bridge.geometry.pose_attributes import boolean_from_text, PoseTextError
from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.nearest_names import hint_from_names
from sdf_pose_bridge.printed_text import shortened
from sdf_pose_bridge.sdformat.elements import (
    Elements,
    ElementsBuilder,
    FrameDetails,
    ModelDetails,
    NO_ELEMENT,
)
from sdf_pose_bridge.sdformat.grammar import Definition, definition_of, Item, Kind
from sdf_pose_bridge.sdformat.inertials import inertial_from_element
from sdf_pose_bridge.sdformat.joints import check_children_of_joint, joint_details_from_element
from sdf_pose_bridge.sdformat.plugins import plugins_of, sensor_details_from_element
from sdf_pose_bridge.sdformat.poses import EULER_RPY, pose_format_of, pose_numbers_from_text
from sdf_pose_bridge.sdformat.shapes import check_material, check_submesh, shape_of
from sdf_pose_bridge.sdformat.sibling_names import check_scoped_names, SiblingNames
from sdf_pose_bridge.sdformat.source_formats import SourceFormat
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.specification import URDF_TAGS
from sdf_pose_bridge.sdformat.undefined import UndefinedReporter
from sdf_pose_bridge.sdformat.values import choice_fault, frame_of_attribute, judged_value
from sdf_pose_bridge.sdformat.xml_tree import (
    attribute_of,
    described,
    text_of,
    written_tag,
    XmlElement,
)

_SCOPES = (Kind.WORLD, Kind.MODEL)
_CHECKS: Mapping[Definition, Callable[[XmlElement, Sources], None]] = {
    definition_of('material', has_frames=True): check_material,
    definition_of('submesh', has_frames=True): check_submesh,
    definition_of('joint'): partial(check_children_of_joint, tags=('parent', 'child')),
    definition_of('old_joint_state'): partial(check_children_of_joint, tags=('angle',))}
"""Functions that check elements without a frame."""


def elements_from_tree(
    root: XmlElement, sources: Sources, *, shapes: bool = False, plugins: bool = False,
) -> Elements:
    """
    Read all elements with a pose.

    :param root: the ``sdf`` element of a tree in the newest version. An ``<include>`` in it is
        one that was not found.
    :param sources: takes errors and warnings about structure, names, attributes and values;
        references are not looked up here.
    :param shapes: whether to read shapes, masses and the dynamics of joints.
    :param plugins: whether to read plugins.
    :return: the elements. An element with an error is kept if possible, so that further errors are
        found and none only follows from the first.
    """
    sources.known_places = {}
    if sources.may_hold_scoped_names:
        check_scoped_names(root, sources)
    return ElementReader(sources, shapes=shapes, plugins=plugins).elements(root)


class _Scope(NamedTuple):
    """The model, world or root whose names references use."""

    path: str
    """The file of the parent element, which a merged element may not share with its scope."""
    element: int = NO_ELEMENT
    """Its index in the table; -1 for the file itself."""
    is_checked: bool = False
    """Whether all values in it are checked already, as those of an included file."""


class ElementReader:
    """Reads elements by their definitions; errors and warnings are added to the sources."""

    def __init__(self, sources: Sources, *, shapes: bool = False, plugins: bool = False) -> None:
        self._sources = sources
        self._reads_plugins = plugins
        self._table = ElementsBuilder(sources.paths, has_shapes=shapes)
        sources.usage.elements.append(self._table.names)
        self._names = SiblingNames(self._table, sources)
        self._undefined = UndefinedReporter(sources, SourceFormat.SDFORMAT)
        self._readers_of_details: dict[Kind, tuple[str, Callable[[XmlElement], Any]]] = {
            Kind.MODEL: ('models', _model_details),
            Kind.FRAME: ('frames', lambda xml: FrameDetails(
                frame_of_attribute(xml, 'attached_to'), sources.origin(xml).placement_frame)),
            Kind.JOINT: ('joints', partial(
                joint_details_from_element, sources=sources, reads_dynamics=shapes)),
            Kind.SENSOR: ('sensors', partial(
                sensor_details_from_element, reads_topics=plugins)),
            Kind.INERTIAL: ('inertials', partial(
                inertial_from_element, sources=sources, reads_masses=shapes)),
        }
        """Details of some kinds: the field of the elements, and the function that reads it."""
        if shapes:
            for kind in (Kind.VISUAL, Kind.COLLISION):
                self._readers_of_details[kind] = ('shapes', shape_of)

    def elements(self, root: XmlElement) -> Elements:
        """Read worlds, and the one model, light or actor that may stand beside them."""
        definition = definition_of('sdf', has_frames=True)
        top = _Scope(self._sources.path(root))
        first = ''
        for child in root:
            child_definition = definition.children.get(child.tag)
            if child_definition is None:
                self._undefined.report_element(child, definition)
            elif child_definition.kind is Kind.WORLD:
                self._read(child, child_definition, top)
            elif first:
                self._check_attributes(child, child.keys(), child_definition)
                error: type[SdfError] = DuplicateNameError
                msg = f'{first} stands at the top of this file already'
                if described(child) != first:
                    error = ElementIncorrectTypeError
                    msg = (f'{described(child)} stands at the top of this file after {first}; '
                           'only one model, light or actor may')
                self._sources.error_in_name(error, child, msg)
            else:
                first = described(child)
                index = self._table.add(
                    Kind.ROOT, ROOT_FRAME, NO_ELEMENT, NO_ELEMENT,
                    self._sources.file_indices[top.path], self._sources.line(child))
                self._read(child, child_definition, top._replace(element=index), index)
        if not self._table.names:
            self._sources.warning(root, 'the file has no world, model, light or actor')
        return self._table.elements(self._sources.problems)

    def is_valid(
        self, xml: XmlElement, definition: Definition, *, with_children: bool = True,
    ) -> bool:
        """
        Check the attributes and values in an element that is not read with the tree, or before it.

        :param with_children: whether to check its child elements, too.
        :return: whether there are no errors.
        """
        before = self._sources.problems.error_count
        if definition.value is None:
            self._read(xml, definition, _Scope(''), with_children=with_children)
        else:
            self._read_value(xml, definition, definition.value, _Scope(''), NO_ELEMENT)
        return self._sources.problems.error_count == before

    # The walk

    def _read(
        self, xml: XmlElement, definition: Definition, scope: _Scope, parent: int = NO_ELEMENT,
        depth: int = 1, *, with_children: bool = True,
    ) -> None:
        """
        Read an element with content.

        :param parent: index of its parent element; -1 if this has no frame.
        """
        if definition.kind is not None and parent >= 0 and self._table.kinds[parent] == Kind.ACTOR:
            # Nothing can refer to the links and joints of actors: they are only checked, and their
            # names may repeat.
            part = ElementReader(self._sources)
            part._read(xml, definition, scope._replace(element=NO_ELEMENT), depth=depth)
            part._table.elements(self._sources.problems)
            return
        attributes = xml.keys()
        if attributes or definition.has_required_attributes:
            self._check_attributes(xml, attributes, definition, is_checked=scope.is_checked)
        element = NO_ELEMENT
        if definition.kind is not None:
            element, scope = self._added(xml, definition, definition.kind, scope, parent)
            if element == NO_ELEMENT:
                definition = definition_of(definition.identifier)
        elif definition in _CHECKS:
            _CHECKS[definition](xml, self._sources)
        elif definition.identifier == 'include' and parent != NO_ELEMENT:
            missing_includes = self._table.details['missing_includes']
            missing_includes.setdefault(parent, {}).update(self._sources.origin(xml).missing)
            return
        self._sources.check_depth(depth, xml)
        definitions, is_checked = definition.children, scope.is_checked
        for child in xml if with_children else ():
            child_definition = definitions.get(child.tag)
            if child_definition is None:
                if not (definition.takes_any_children or is_checked):
                    self._undefined.report_element(child, definition)
            elif is_checked and not child_definition.concerns_frames:
                pass
            elif child_definition.value is None:
                self._read(child, child_definition, scope, element, depth + 1)
            else:
                self._read_value(child, child_definition, child_definition.value, scope, element)

    def _read_value(
        self, xml: XmlElement, definition: Definition, rule: Item, scope: _Scope, parent: int,
    ) -> None:
        """Read an element that has a value instead of content."""
        attributes = xml.keys()
        if attributes or definition.has_required_attributes:
            self._check_attributes(xml, attributes, definition, is_checked=scope.is_checked)
        if definition.is_pose:
            self._read_pose(xml, attributes, definition, parent)
        elif not rule.is_plain(xml.text or ''):
            fault, doubt = judged_value(text_of(xml), rule)
            if fault:
                self._sources.error(ElementInvalidError, xml, f'{_described_value(xml)} {fault}')
            elif doubt:
                self._sources.warning(xml, f'{_described_value(xml)} {doubt}')
        if len(xml):
            for child in xml:
                self._undefined.report_element(child, definition)

    def _added(
        self, xml: XmlElement, definition: Definition, kind: Kind, scope: _Scope, parent: int,
    ) -> tuple[int, _Scope]:
        """
        Add an element to the table, unless its name has an error.

        :return: its index, or -1; and the scope of its content.
        """
        table, path = self._table, scope.path
        name = (self._names.add(kind, xml, parent, path) if definition.has_name
                else definition.identifier)
        if name is None:
            return NO_ELEMENT, scope
        origin = self._sources.origin(xml)
        if origin.file is not None:
            path = origin.file
        index = table.add(
            kind, name, parent, scope.element,
            self._sources.file_indices[origin.pose_file or path],
            self._sources.line(xml))
        if origin.include is not None:
            table.details['includes'][index] = origin.include
        if kind in self._readers_of_details:
            field, details_from_element = self._readers_of_details[kind]
            details = details_from_element(xml)
            if details is not None:
                table.details[field][index] = details
        if self._reads_plugins and (found := plugins_of(xml)):
            table.details['plugins'][index] = found
        if kind in _SCOPES or path != scope.path or origin.is_checked:
            scope = _Scope(
                path, index if kind in _SCOPES else scope.element,
                scope.is_checked or origin.is_checked)
        return index, scope

    # Attributes and poses

    def _check_attributes(
        self, xml: XmlElement, names: Iterable[str], definition: Definition, *,
        is_checked: bool = False,
    ) -> None:
        for name in names:
            if name not in definition.attributes:
                self._undefined.report_attribute(name, xml, definition)
        for rule in definition.checked_attributes:
            name, text = rule.name, xml.get(rule.name)
            choice = rule.choice if definition.has_frames else None
            if (is_checked and choice is None) or (
                    not rule.required if text is None else rule.is_plain(text)):
                continue
            value = attribute_of(xml, name)
            if text is None:
                msg = f'<{written_tag(xml)}> has no {name}'
                self._sources.error(AttributeMissingError, xml, msg)
            elif rule.choice is None or not value:
                fault, doubt = judged_value(value, rule)
                if fault:
                    self._sources.error(AttributeInvalidError, xml, f'{name}="{value}" {fault}')
                elif doubt:
                    self._sources.warning(xml, f'{name}="{value}" of <{written_tag(xml)}> {doubt}')
            elif choice is not None and (fault := choice_fault(value, choice)):
                error = ElementInvalidError if definition.kind is None else AttributeInvalidError
                hint = hint_from_names(value, choice.texts) if (
                    self._sources.problems.allows_hint()) else ''
                msg = f'{name}="{value}" of <{written_tag(xml)}> {fault}{hint}'
                self._sources.error(error, xml, msg)

    def _read_pose(
        self, xml: XmlElement, attributes: Sequence[str], definition: Definition, parent: int,
    ) -> None:
        """Keep the pose of an element, or check another pose."""
        text, pose_format = text_of(xml), EULER_RPY
        try:
            if attributes:
                pose_format = pose_format_of(xml)
            numbers, doubt = pose_numbers_from_text(text, pose_format)
        except PoseTextError as error:
            self._sources.error(ElementInvalidError, xml, str(error))
            numbers, doubt = pose_numbers_from_text('', pose_format)
        if doubt:
            self._sources.warning(xml, doubt)
        if parent == NO_ELEMENT:
            if definition.is_required and not text:
                msg = f'<{written_tag(xml)}> is empty; it must have a value'
                self._sources.error(ElementInvalidError, xml, msg)
        elif parent in self._table.pose_lines:
            self._sources.warning(xml, 'a second <pose> is ignored; the first one counts')
        else:
            if attributes:
                self._read_relative_to(xml, definition, parent)
            self._table.set_pose(parent, text, numbers, pose_format, self._sources.line(xml))

    def _read_relative_to(self, xml: XmlElement, definition: Definition, index: int) -> None:
        table, relative_to = self._table, frame_of_attribute(xml, 'relative_to')
        if not relative_to or 'relative_to' not in definition.attributes:
            return
        ignored = f'relative_to="{relative_to}" is ignored'
        if table.kinds[index] == Kind.ACTOR:
            self._sources.warning(xml, f'{ignored}; an actor is placed in the world')
        elif table.kinds[index] == Kind.LIGHT and table.kinds[table.parents[index]] == Kind.ROOT:
            msg = f'{ignored}; a light at the top of a file is placed in the implicit root'
            self._sources.warning(xml, msg)
        else:
            table.details['relative_to'][index] = relative_to


# Details of some kinds

def _model_details(xml: XmlElement) -> ModelDetails:
    static, urdf = None, []
    for child in xml:
        if child.tag == 'static' and static is None:
            static = text_of(child)
        elif child.tag in URDF_TAGS:
            urdf.append(etree.tostring(
                child, encoding='unicode', pretty_print=True, with_tail=False).rstrip('\n'))
    return ModelDetails(
        boolean_from_text(static or '') is True, frame_of_attribute(xml, 'canonical_link'),
        frame_of_attribute(xml, 'placement_frame'), tuple(urdf))


def _described_value(xml: XmlElement) -> str:
    value = shortened(text_of(xml))
    return f'"{value}" of <{written_tag(xml)}>' if value else f'<{written_tag(xml)}>'
