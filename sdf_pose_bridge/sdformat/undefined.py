# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Warn of elements and attributes that SDFormat does not define; most of them are misspelt.

libsdformat warns of the same ones (``readXml`` and ``readAttributes`` in ``parser.cc``). Names
with a prefix, and the content of plugins, cause no warning.
"""

from __future__ import annotations

from collections.abc import Iterable

from sdf_pose_bridge.names import NameIndex
from sdf_pose_bridge.sdformat.grammar import Definition, Kind
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.specification import URDF_TAGS
from sdf_pose_bridge.sdformat.xml_tree import written_tag, XmlElement

_ELEMENT_HINTS = {
    'origin': 'it is from URDF; SDFormat has <pose>x y z roll pitch yaw</pose>',
    'sensor/ignition_frame_id': 'it is used all the same; version 1.12 has <frame_id> instead',
    'gz_frame_id': 'Gazebo looks for it in <sensor>',
    'ignition_frame_id': 'Gazebo looks for it in <sensor>',
    **{f'model/{tag}': 'URDF that is made of the model has it' for tag in URDF_TAGS},
}
"""The ends of messages about elements, by tag, or parent and tag."""

_PLACES = {
    kind.label: ' or '.join(f'<{parent}>' for parent in kind.parents)
    for kind in Kind if kind.parents}
"""The elements that can contain each kind of element."""

_ATTRIBUTE_HINTS = {
    ('pose', 'frame'): 'since version 1.7 it is relative_to',
    ('inertial/pose', 'relative_to'): 'an inertial is placed in its link',
    ('parent', 'link'): 'it is from URDF; SDFormat has <parent>name of a frame</parent>',
    ('child', 'link'): 'it is from URDF; SDFormat has <child>name of a frame</child>',
}
"""The ends of messages about attributes, by identifier of the element and name."""


class UndefinedReporter:
    """Warns of undefined elements and attributes."""

    def __init__(self, sources: Sources) -> None:
        self._sources = sources
        self._nearest: dict[tuple[str, str, str], str] = {}

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
        if tag == 'include':
            # An <include> elsewhere was replaced, or is reported already.
            if parent.value_type is not None:
                self._sources.warning(xml, f'<include> in <{written_tag(parent_xml)}> is not read')
            return
        hint = _ELEMENT_HINTS.get(f'{parent.identifier}/{tag}', '') or _ELEMENT_HINTS.get(tag, '')
        if not hint and tag in parent.attributes:
            hint = f'it is an attribute: {tag}="..."'
        elif not hint and tag in _PLACES:
            hint = f'it can stand in {_PLACES[tag]}'
        elif not hint:
            hint = self._did_you_mean(tag, parent.identifier, map(str, parent.children), '<{}>')
        parent_tag, outer = written_tag(parent_xml), parent_xml.getparent()
        # <ode> and some others have several definitions, each in another element.
        place = f'<{parent_tag}>' if parent.identifier == parent_tag or outer is None else (
            f'<{parent_tag}> of <{written_tag(outer)}>')
        self._warn(xml, f'<{tag}> in {place}', hint)

    def report_attributes(self, xml: XmlElement, definition: Definition) -> None:
        """Warn of the undefined attributes of an element."""
        names = xml.keys()
        for name in names:
            # lxml writes the namespace of a prefix in braces.
            if not (name in definition.attributes or ':' in name or '{' in name):
                self._report_attribute(xml, name, definition)

    def _report_attribute(self, xml: XmlElement, name: str, definition: Definition) -> None:
        if self._is_only_counted():
            return
        hint = _ATTRIBUTE_HINTS.get((definition.identifier, name), '')
        if not hint and name in definition.children:
            hint = f'it is an element: <{name}>'
        elif not hint:
            hint = self._did_you_mean(name, definition.identifier, definition.attributes, '{}')
        self._warn(xml, f'{name}="{xml.get(name)}" of <{written_tag(xml)}>', hint)

    def _is_only_counted(self) -> bool:
        """Return whether the limit of warnings is reached, and count this one."""
        is_kept = self._sources.problems.keeps_warnings()
        if not is_kept:
            self._sources.problems.count_more(errors=0, warnings=1)
        return not is_kept

    def _warn(self, xml: XmlElement, what: str, hint: str) -> None:
        ending = f'; {hint}' if hint else ''
        self._sources.warning(xml, f'{what} is not defined in SDFormat{ending}')

    def _did_you_mean(self, name: str, parent: str, names: Iterable[str], form: str) -> str:
        # Most undefined elements of a file have one of a few names.
        key = form, parent, name
        if key not in self._nearest and self._sources.problems.allows_hint():
            self._nearest[key] = NameIndex(names).nearest(name)
        nearest = self._nearest.get(key, '')
        return f'did you mean {form.format(nearest)}?' if nearest else ''
