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

_HINTS = {
    'origin': 'it is from URDF; SDFormat has <pose>x y z roll pitch yaw</pose>',
    'sensor/ignition_frame_id': 'it is used all the same; version 1.12 has <frame_id> instead',
    'gz_frame_id': 'Gazebo looks for it in <sensor>',
    'ignition_frame_id': 'Gazebo looks for it in <sensor>',
    **{f'model/{tag}': 'URDF that is made of the model has it' for tag in URDF_TAGS},
    'pose/@frame': 'since version 1.7 it is relative_to',
    'inertial/pose/@relative_to': 'an inertial is placed in its link',
    'parent/@link': 'it is from URDF; SDFormat has <parent>name of a frame</parent>',
    'child/@link': 'it is from URDF; SDFormat has <child>name of a frame</child>',
}
"""The ends of messages about elements and ``@`` attributes, by name, alone or behind the
identifier of the element around it."""

_PLACES = {
    kind.label: f'it can stand in {" or ".join(f"<{parent}>" for parent in kind.parents)}'
    for kind in Kind if kind.parents}
"""The ends of messages about the kinds of elements."""


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
            if parent.value is not None:
                self._sources.warning(xml, f'<include> in <{written_tag(parent_xml)}> is not read')
            return
        likely = _PLACES.get(tag, '')
        if tag in parent.attributes:
            likely = f'it is an attribute: {tag}="..."'
        parent_tag, outer = written_tag(parent_xml), parent_xml.getparent()
        # <ode> and some others have several definitions, each in another element.
        place = f'<{parent_tag}>' if parent.identifier == parent_tag or outer is None else (
            f'<{parent_tag}> of <{written_tag(outer)}>')
        hint = _hint(parent, tag) or likely or self._did_you_mean(
            tag, parent.identifier, map(str, parent.children), '<{}>')
        self._warn(xml, f'<{tag}> in {place}', hint)

    def report_attributes(self, xml: XmlElement, definition: Definition) -> None:
        """Warn of the undefined attributes of an element."""
        names = xml.keys()
        for name in names:
            # lxml writes the namespace of a prefix in braces.
            if (name in definition.attributes or ':' in name or '{' in name
                    or self._is_only_counted()):
                continue
            likely = f'it is an element: <{name}>' if name in definition.children else ''
            hint = _hint(definition, f'@{name}') or likely or self._did_you_mean(
                name, definition.identifier, definition.attributes, '{}')
            self._warn(xml, f'{name}="{xml.get(name)}" of <{written_tag(xml)}>', hint)

    def _is_only_counted(self) -> bool:
        if self._sources.problems.keeps_warnings():
            return False
        self._sources.problems.count_more(errors=0, warnings=1)
        return True

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


def _hint(definition: Definition, name: str) -> str:
    return _HINTS.get(f'{definition.identifier}/{name}') or _HINTS.get(name, '')
