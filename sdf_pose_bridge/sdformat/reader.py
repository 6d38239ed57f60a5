# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Fill the table of elements in one walk over a tree.

Every element is visited once. By the grammar, an element with a frame becomes a row of the table,
a value is checked, and an unknown element is skipped.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import chain, takewhile
from typing import Any, NamedTuple

from lxml import etree

from sdf_pose_bridge.errors import (
    AttributeInvalidError,
    AttributeMissingError,
    DuplicateNameError,
    ElementIncorrectTypeError,
    ElementInvalidError,
    ReservedNameError,
)
from sdf_pose_bridge.names import hint_from_names, ROOT_FRAME, SEPARATOR, shortened
from sdf_pose_bridge.sdformat.elements import (
    Elements,
    ElementsBuilder,
    FrameDetails,
    ModelDetails,
    NO_ELEMENT,
    SensorDetails,
)
from sdf_pose_bridge.sdformat.grammar import Definition, definition_of, Kind
from sdf_pose_bridge.sdformat.inertials import inertial_from_element
from sdf_pose_bridge.sdformat.joints import check_children_of_joint, joint_details_from_element
from sdf_pose_bridge.sdformat.poses import (
    pose_format_of,
    pose_numbers_from_text,
    PoseFormat,
    PoseTextError,
)
from sdf_pose_bridge.sdformat.shapes import check_material, check_submesh, shape_of
from sdf_pose_bridge.sdformat.sibling_names import SiblingNames
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.specification import CAMERA_TYPES, URDF_TAGS
from sdf_pose_bridge.sdformat.undefined import UndefinedReporter
from sdf_pose_bridge.sdformat.values import (
    boolean_from_text,
    choice_fault,
    frame_of_attribute,
    is_of_type,
    judged_value,
)
from sdf_pose_bridge.sdformat.versions import allows_scoped_names
from sdf_pose_bridge.sdformat.xml_tree import (
    attribute_of,
    child_elements,
    child_value,
    described,
    first_child,
    is_foreign_itself,
    text_of,
    value_of,
    WHITE_SPACE,
    with_ancestors,
    written_tag,
    XmlElement,
)

_FRAME_ID_TAGS = ('frame_id', 'gz_frame_id', 'ignition_frame_id')
"""Elements of a sensor with the frame id of its messages; the first of them counts."""
_CHECKS = {'material': check_material, 'submesh': check_submesh}
"""Functions that check elements without a frame, by the identifiers of these."""
_CHECKS_OF_UNREAD = {
    'joint': partial(check_children_of_joint, tags=('parent', 'child')),
    'old_joint_state': partial(check_children_of_joint, tags=('angle',))}
"""The same for elements that libsdformat does not load, such as those in a state."""


def elements_from_tree(root: XmlElement, sources: Sources, *, shapes: bool = False) -> Elements:
    """
    Read all elements with a pose.

    :param root: the ``sdf`` element of a tree in the newest version. An ``<include>`` in it is
        one that was not found.
    :param sources: takes errors and warnings about structure, names, attributes and values;
        references are not looked up here.
    :param shapes: whether to read shapes, masses and the dynamics of joints.
    :return: the elements. An element with an error is kept if possible, so that further errors are
        found and none only follows from the first.
    """
    sources = sources.of_unchanged_trees()
    if sources.may_hold_scoped_names:
        _check_scoped_names(root, sources)
    return _Reader(sources, shapes=shapes).elements(root)


def is_valid_element(xml: XmlElement, definition: Definition, sources: Sources) -> bool:
    """
    Check the attributes and values in an element that is not read with the tree, or before it.

    :param sources: takes errors and warnings.
    :return: whether there are no errors.
    """
    part = sources.with_own_problems()
    _Reader(part).check(xml, definition)
    part.problems.extend_parent()
    return not part.problems.errors


def _check_scoped_names(root: XmlElement, sources: Sources) -> None:
    """Report names with ``::`` in files without scoped names, and in files that they include."""
    is_allowed: dict[XmlElement | None, bool] = {None: True}
    xmls: list[XmlElement] = root.xpath('//*[contains(@name, "::")]')
    for xml in xmls:
        # The name may be in the file that includes the element.
        named_in = xml.getparent() if sources.origin(xml).is_named_by_include else xml
        around = () if named_in is None else with_ancestors(named_in)
        for each in reversed([*takewhile(lambda each: each not in is_allowed, around)]):
            file = sources.origin(each).file
            is_allowed[each] = is_foreign_itself(each) or (
                is_allowed[each.getparent()]
                and (file is None or allows_scoped_names(sources.versions[file])))
        if is_allowed[named_in]:
            continue
        msg = f'the name "{xml.get("name")}" holds "{SEPARATOR}", which separates scopes'
        sources.error_in_name(ReservedNameError, xml, msg)


class _Scope(NamedTuple):
    """The model, world or root whose names references use, or an actor."""

    table: ElementsBuilder
    """Takes the elements in it."""
    names: SiblingNames
    path: str
    """The file of the parent element, which a merged element may not share with its scope."""
    element: int = NO_ELEMENT
    """Its index in the table; -1 for the file itself, and for a part of an actor."""


class _Reader:

    def __init__(self, sources: Sources, *, shapes: bool = False) -> None:
        self._sources = sources
        self._deepest = sources.usage.limits.depth
        self._table = ElementsBuilder(sources.paths, has_shapes=shapes)
        self._parts_of_actors = ElementsBuilder(sources.paths)
        """Links and joints of actors with their content, which are checked, but have no frames."""
        self._undefined = UndefinedReporter(sources)
        self._file_indices = sources.file_indices
        self._readers_of_details: dict[Kind, tuple[str, Callable[[XmlElement], Any]]] = {
            Kind.MODEL: ('models', _model_details),
            Kind.FRAME: ('frames', partial(_frame_details, sources=sources)),
            Kind.JOINT: ('joints', partial(
                joint_details_from_element, sources=sources, reads_dynamics=shapes)),
            Kind.SENSOR: ('sensors', _sensor_details),
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
        scope = self._new_scope(self._table, self._sources.path(root))
        first = ''
        for child in root:
            child_definition = definition.children.get(child.tag)
            if child_definition is None:
                self._undefined.report_element(child, definition)
            elif child_definition.kind is Kind.WORLD:
                self.read(child, child_definition, scope)
            elif first:
                self._check_attributes(child, child_definition)
                self._report_second_top(child, first)
            else:
                first = described(child)
                index = self._table.add(
                    Kind.ROOT, ROOT_FRAME, NO_ELEMENT, NO_ELEMENT, self._file_indices[scope.path],
                    self._sources.line(child))
                self.read(child, child_definition, scope._replace(element=index), index)
        if not self._table.names:
            self._sources.warning(root, 'the file has no world, model, light or actor')
        self._parts_of_actors.elements(self._sources.problems)
        return self._table.elements(self._sources.problems)

    def _report_second_top(self, xml: XmlElement, first: str) -> None:
        if described(xml) == first:
            msg = f'{first} stands at the top of this file already'
            self._sources.error_in_name(DuplicateNameError, xml, msg)
        else:
            msg = (f'{described(xml)} stands at the top of this file after {first}; only one '
                   'model, light or actor may')
            self._sources.error_in_name(ElementIncorrectTypeError, xml, msg)

    def _new_scope(self, table: ElementsBuilder, path: str) -> _Scope:
        return _Scope(table, SiblingNames(table, self._sources), path)

    # The walk

    def check(self, xml: XmlElement, definition: Definition) -> None:
        """Check the values of an element that is no part of the tree, with its content."""
        self.read(xml, definition, self._new_scope(self._table, ''))

    def read(
        self, xml: XmlElement, definition: Definition, scope: _Scope, parent: int = NO_ELEMENT,
        depth: int = 1,
    ) -> None:
        """
        Read an element and its content.

        :param parent: index of its parent element; -1 if this has no frame.
        """
        if definition.has_required_attributes or xml.keys():
            self._check_attributes(xml, definition)
        if definition.is_pose:
            self._read_pose(xml, definition, scope, parent)
        elif definition.value_type is not None:
            fault, doubt = judged_value(text_of(xml), definition)
            if fault:
                self._sources.error(ElementInvalidError, xml, f'{_described_value(xml)} {fault}')
            elif doubt:
                self._sources.warning(xml, f'{_described_value(xml)} {doubt}')
        elif definition.identifier == 'include' and parent != NO_ELEMENT:
            missing_includes = scope.table.details['missing_includes']
            missing_includes.setdefault(parent, {}).update(self._sources.origin(xml).missing)
        else:
            kind, element = definition.kind, NO_ELEMENT
            if kind is None:
                checks = _CHECKS if definition.has_frames else _CHECKS_OF_UNREAD
                if definition.identifier in checks:
                    checks[definition.identifier](xml, self._sources)
            else:
                if self._sources.origin(xml).is_checked:
                    definition = definition_of(
                        definition.identifier, has_frames=True, is_checked=True)
                element, scope = self._added(xml, definition, kind, scope, parent)
                if element == NO_ELEMENT:
                    definition = definition_of(definition.identifier)
            if depth > self._deepest:
                self._sources.check_depth(depth, xml)
            definitions = definition.children
            for child in xml:
                child_definition = definitions.get(child.tag)
                if child_definition is None:
                    if not definition.takes_any_children:
                        self._undefined.report_element(child, definition)
                    continue
                self.read(child, child_definition, scope, element, depth + 1)
                if child_definition.value_type is not None and len(child):
                    for grandchild in child:
                        self._undefined.report_element(grandchild, child_definition)

    def _added(
        self, xml: XmlElement, definition: Definition, kind: Kind, scope: _Scope, parent: int,
    ) -> tuple[int, _Scope]:
        """
        Add an element to the table, unless its name has an error.

        :return: its index, or -1; and the scope of its content.
        """
        if parent >= 0 and scope.table.kinds[parent] == Kind.ACTOR:
            # Nothing can refer to the links and joints of actors, so their names may repeat.
            scope, parent = self._new_scope(self._parts_of_actors, scope.path), NO_ELEMENT
        table, names, path, scope_element = scope
        has_name = 'name' in definition.attributes
        name = names.add(kind, xml, parent, path) if has_name else kind.label
        if name is None:
            return NO_ELEMENT, scope
        origin = self._sources.origin(xml)
        if origin.file is not None:
            path = origin.file
        index = table.add(
            kind, name, parent, scope_element,
            self._file_indices[path if origin.pose is None else origin.pose.file],
            self._sources.line(xml))
        if origin.include is not None:
            table.details['includes'][index] = origin.include
        if kind in self._readers_of_details:
            field, details_from_element = self._readers_of_details[kind]
            details = details_from_element(xml)
            if details is not None:
                table.details[field][index] = details
        if definition.is_scope or path != scope.path:
            scope = _Scope(table, names, path, index if definition.is_scope else scope_element)
        return index, scope

    # Attributes and poses

    def _check_attributes(self, xml: XmlElement, definition: Definition) -> None:
        self._undefined.report_attributes(xml, definition)
        for name, attribute in definition.checked_attributes:
            value = xml.get(name)
            if value is None:
                if attribute.is_required:
                    msg = f'<{written_tag(xml)}> has no {name}'
                    self._sources.error(AttributeMissingError, xml, msg)
            elif value.strip() and not is_of_type(value.strip(), attribute.value_type):
                msg = f'{name}="{value.strip()}" is not {attribute.value_type.description}'
                self._sources.error(AttributeInvalidError, xml, msg)
            elif attribute.is_required and not value.strip():
                msg = f'{name}="{value}" of <{written_tag(xml)}> is empty'
                self._sources.error(AttributeInvalidError, xml, msg)
            elif attribute.choice is not None:
                fault = choice_fault(value.strip(WHITE_SPACE), attribute.choice)
                if fault:
                    error = (
                        ElementInvalidError if definition.kind is None else AttributeInvalidError)
                    msg = f'{name}="{value.strip(WHITE_SPACE)}" of <{written_tag(xml)}> {fault}'
                    hint = hint_from_names(value.strip(WHITE_SPACE), attribute.choice.texts) if (
                        self._sources.problems.allows_hint()) else ''
                    self._sources.error(error, xml, msg + hint)

    def _read_pose(
        self, xml: XmlElement, definition: Definition, scope: _Scope, parent: int,
    ) -> None:
        """Keep the pose of an element, or check another pose."""
        table = scope.table
        is_first = parent != NO_ELEMENT and not table.has_pose[parent]
        if is_first and xml.keys():
            self._read_relative_to(xml, definition, table, parent)
        try:
            text, pose_format = text_of(xml), pose_format_of(xml)
        except PoseTextError as error:
            self._sources.error(ElementInvalidError, xml, str(error))
            text, pose_format = '', PoseFormat()
        if is_first:
            table.set_pose(parent, text, pose_format, self._sources.line(xml))
            return
        if definition.is_required and not text_of(xml):
            msg = f'<{written_tag(xml)}> is empty; it must have a value'
            self._sources.error(ElementInvalidError, xml, msg)
        try:
            pose_numbers_from_text(text, pose_format)
        except PoseTextError as error:
            self._sources.error(ElementInvalidError, xml, str(error))
        if parent != NO_ELEMENT:
            self._sources.warning(xml, 'a second <pose> is ignored; the first one counts')

    def _read_relative_to(
        self, xml: XmlElement, definition: Definition, table: ElementsBuilder, index: int,
    ) -> None:
        relative_to = frame_of_attribute(xml, 'relative_to')
        if not relative_to or 'relative_to' not in definition.attributes:
            return
        reason = ''
        if table.kinds[index] == Kind.ACTOR:
            reason = 'an actor is placed in the world'
        elif (table.kinds[index] == Kind.LIGHT
                and table.kinds[table.parents[index]] == Kind.ROOT):
            reason = 'a light at the top of a file is placed in the implicit root'
        if reason:
            self._sources.warning(xml, f'relative_to="{relative_to}" is ignored; {reason}')
        else:
            table.details['relative_to'][index] = relative_to


# Details of some kinds

def _model_details(xml: XmlElement) -> ModelDetails:
    return ModelDetails(
        boolean_from_text(child_value(xml, 'static')) is True,
        frame_of_attribute(xml, 'canonical_link'), frame_of_attribute(xml, 'placement_frame'),
        tuple(
            etree.tostring(child, encoding='unicode', pretty_print=True, with_tail=False).rstrip()
            for child in child_elements(xml, *URDF_TAGS)))


def _described_value(xml: XmlElement) -> str:
    value = shortened(text_of(xml).strip(WHITE_SPACE))
    return f'"{value}" of <{written_tag(xml)}>' if value else f'<{written_tag(xml)}>'


def _frame_details(xml: XmlElement, sources: Sources) -> FrameDetails:
    return FrameDetails(
        frame_of_attribute(xml, 'attached_to'), sources.origin(xml).placement_frame)


def _sensor_details(xml: XmlElement) -> SensorDetails:
    frame_ids = chain.from_iterable(child_elements(xml, tag) for tag in _FRAME_ID_TAGS)
    camera = first_child(xml, 'camera')
    sensor_type = attribute_of(xml, 'type')
    return SensorDetails(
        sensor_type, next(filter(None, map(value_of, frame_ids)), ''),
        camera is not None or sensor_type in CAMERA_TYPES,
        '' if camera is None else child_value(camera, 'optical_frame_id'))
