# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Warn of elements and attributes that SDFormat or URDF does not define; most of them are misspelt.

libsdformat warns of the same ones in SDFormat (``readXml`` and ``readAttributes`` in
``parser.cc``). Names with a prefix, and the content of plugins, cause no warning.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from itertools import filterfalse

from sdf_pose_bridge.nearest_names import NameIndex
from sdf_pose_bridge.sdformat.grammar import Definition, definition_of
from sdf_pose_bridge.sdformat.source_formats import SourceFormat
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.specification import URDF_TAGS
from sdf_pose_bridge.sdformat.xml_tree import with_ancestors, written_tag, XmlElement

_HINTS = {
    'origin': 'it is from URDF; SDFormat has <pose>x y z roll pitch yaw</pose>',
    'sensor/ignition_frame_id':
        'no supported release of Gazebo reads it; write <gz_frame_id>, in version 1.12 <frame_id>',
    'gz_frame_id': 'Gazebo looks for it in <sensor>',
    'ignition_frame_id': 'write <gz_frame_id> in <sensor>',
    **{f'model/{tag}': 'URDF that is made of the model has it' for tag in URDF_TAGS},
    'pose/@frame': 'since version 1.7 it is relative_to',
    'use_parent_model_frame': 'since version 1.7, true is <xyz expressed_in="__model__">',
    'inertial/pose/@relative_to': 'an inertial is placed in its link',
    'parent/@link': 'it is from URDF; SDFormat has <parent>name of a frame</parent>',
    'child/@link': 'it is from URDF; SDFormat has <child>name of a frame</child>',
}
"""The ends of messages about elements and ``@`` attributes, by name, alone or behind the
identifier of the element around it."""

_MOST_NAMES = 6
"""Largest number of attributes that a message names."""


class UndefinedReporter:
    """
    Warns of undefined elements and attributes.

    :param source_format: the format that defines them.
    """

    def __init__(self, sources: Sources, source_format: SourceFormat) -> None:
        self._sources = sources
        self._format = source_format
        self._hints = _HINTS if source_format is SourceFormat.SDFORMAT else {}
        self._found_hints: dict[tuple[str, str], str] = {}
        self._last: tuple[object, ...] = ()

    def report_element(self, xml: XmlElement, parent: Definition) -> None:
        """
        Warn of an element.

        :param xml: a child element, or a comment, that the definition of its parent does not know.
        :param parent: the definition of its parent element, which may not take any children.
        """
        tag = written_tag(xml)
        parent_xml = xml.getparent()
        if (not isinstance(xml.tag, str) or ':' in tag or parent_xml is None
                or self._is_only_counted()):
            return
        # Equal elements of one line have one warning, and it takes long to make it again.
        last, self._last = self._last, (parent_xml, tag, xml.items(), self._sources.line(xml))
        if last == self._last:
            return
        if tag == 'include':
            # An <include> elsewhere was replaced, or is reported already.
            if parent.value is not None:
                self._sources.warning(xml, f'<include> in <{written_tag(parent_xml)}> is not read')
            return
        parent_tag, outer = written_tag(parent_xml), parent_xml.getparent()
        # <ode> and some others have several definitions, each in another element.
        place = f'<{parent_tag}>' if outer is None or parent.identifier in (
            parent_tag, f'urdf_{parent_tag}') else f'<{parent_tag}> of <{written_tag(outer)}>'
        likely = f'it is an attribute: {tag}="..."' if tag in parent.attributes else ''
        hint = self._hint(parent, tag) or likely or self._found_hint(
            parent, tag, lambda: self._place_of(tag, parent, parent_xml) or _did_you_mean(
                tag, map(str, parent.children), '<{}>'))
        self._warn(xml, f'<{tag}> in {place}', hint)

    def report_attribute(self, name: str, xml: XmlElement, definition: Definition) -> None:
        """Warn of an undefined attribute of an element."""
        # lxml writes the namespace of a prefix in braces.
        if ':' in name or '{' in name or self._is_only_counted():
            return
        likely = f'it is an element: <{name}>' if name in definition.children else ''
        hint = self._hint(definition, f'@{name}') or likely or self._found_hint(
            definition, f'@{name}', lambda: _did_you_mean(name, definition.attributes, '{}')
        ) or _choice_of(definition)
        self._warn(xml, f'{name}="{xml.get(name)}" of <{written_tag(xml)}>', hint)

    def report_tree(self, xml: XmlElement, definition: Definition) -> None:
        """Warn of undefined names in an element and below it, except in extensions."""
        for name in filterfalse(definition.attributes.__contains__, xml.keys()):
            self.report_attribute(name, xml, definition)
        for child in xml:
            child_definition = definition.children.get(child.tag)
            if child_definition is None:
                self.report_element(child, definition)
            elif not child_definition.takes_any_children:
                self.report_tree(child, child_definition)

    def _is_only_counted(self) -> bool:
        if self._sources.problems.keeps_warnings():
            return False
        self._sources.problems.count_more(errors=0, warnings=1)
        return True

    def _warn(self, xml: XmlElement, what: str, hint: str) -> None:
        ending = f'; {hint}' if hint else ''
        self._sources.warning(xml, f'{what} is not defined in {self._format.title}{ending}')

    def _hint(self, definition: Definition, name: str) -> str:
        return self._hints.get(f'{definition.identifier}/{name}') or self._hints.get(name, '')

    def _found_hint(self, definition: Definition, name: str, find: Callable[[], str]) -> str:
        """Return a hint that takes long to find; most undefined names of a file are repeated."""
        key = definition.identifier, name
        if key not in self._found_hints and self._sources.problems.allows_hint():
            self._found_hints[key] = find()
        return self._found_hints.get(key, '')

    def _place_of(self, tag: str, parent: Definition, parent_xml: XmlElement) -> str:
        """Return where an element can stand: in a child of its parent, or in an outer element."""
        holders = [*_inner_holders(tag, [parent]), *self._outer_holder(tag, parent_xml)]
        level, known = [parent], set[str]()
        while level and not holders:
            level = [
                child for each in level for child in _inner_definitions(each).values()
                if child.identifier not in known]
            known.update(child.identifier for child in level)
            holders = _inner_holders(tag, level)
        return f'it can stand in {" or ".join(holders)}' if holders else ''

    def _outer_holder(self, tag: str, xml: XmlElement) -> list[str]:
        """Return the nearest element around an element that can hold another one."""
        holder, holders = self._format.tag, list[str]()
        definition = definition_of(holder, has_frames=True)
        for outer in reversed([*with_ancestors(xml)][:-1]):
            if tag in definition.children:
                holders = [f'<{holder}>']
            holder = written_tag(outer)
            definition = definition.children.get(outer.tag, definition)
        return holders


def _did_you_mean(name: str, names: Iterable[str], form: str) -> str:
    nearest = NameIndex(names).nearest(name)
    return f'did you mean {form.format(nearest)}?' if nearest else ''


def _choice_of(definition: Definition) -> str:
    """Return the few attributes that an element can have, as the end of a message."""
    names = [*definition.attributes]
    return f'it can have {", ".join(names)}' if 0 < len(names) <= _MOST_NAMES else ''


def _inner_definitions(definition: Definition) -> Mapping[object, Definition]:
    """Return the definitions of the child elements, without those that are not loaded."""
    return {
        tag: child for tag, child in definition.children.items()
        if child.value is None and (child.has_frames or not definition.has_frames)}


def _inner_holders(tag: str, definitions: Iterable[Definition]) -> list[str]:
    """Return the child elements of some elements that can hold an element."""
    return [*dict.fromkeys(
        f'<{inner}> of <{child.identifier.partition("/")[0]}>' if '/' in child.identifier
        else f'<{inner}>'
        for each in definitions for inner, child in _inner_definitions(each).items()
        if tag in child.children)]
