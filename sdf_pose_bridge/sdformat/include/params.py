# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Change an included model by the parameters of its include (``<experimental:params>``).

Each parameter names an element of the model by ``element_id`` and a change by ``action``: of the
whole element, or of its children one by one. Source: libsdformat's ``ParamPassing.cc``.
"""

from __future__ import annotations

from lxml import etree

from sdf_pose_bridge.errors import (
    AttributeInvalidError,
    AttributeMissingError,
    DuplicateNameError,
    ElementInvalidError,
    ElementMissingError,
)
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.sdformat.grammar import Definition, definition_of, STANDALONE_ELEMENTS
from sdf_pose_bridge.sdformat.include.element_ids import element_by_id, hint_for_id
from sdf_pose_bridge.sdformat.joints import DEFAULT_END
from sdf_pose_bridge.sdformat.reader import is_valid_element
from sdf_pose_bridge.sdformat.sources import PARAMS_TAG, Sources
from sdf_pose_bridge.sdformat.xml_tree import (
    child_elements,
    copy_of,
    text_of,
    written_tag,
    XmlElement,
)

_OWN_ATTRIBUTES = ('element_id', 'action')
_ACTIONS = ('add', 'modify', 'remove', 'replace')
_POSE_FORMAT_ATTRIBUTES = frozenset({'degrees', 'rotation_format'})
_PARTS = ('pose', 'parent', 'child', 'axis', 'axis2')
"""Children that are in the file of their parent element."""


def apply_params(include: XmlElement, top: XmlElement, sources: Sources) -> list[XmlElement]:
    """
    Change an included element by the first ``<experimental:params>`` of its include.

    :param include: the include; it is not changed.
    :param top: the included element.
    :param sources: takes errors and warnings. A parameter with an error is not applied.
    :return: the elements that were added.
    """
    params = next((xml for xml in child_elements(include) if written_tag(xml) == PARAMS_TAG), None)
    if params is None:
        return []
    changer = _Changer(top, sources)
    for xml in child_elements(params):
        changer.apply(xml)
    return changer.added


class _Changer:

    def __init__(self, top: XmlElement, sources: Sources) -> None:
        self.added: list[XmlElement] = []
        self._top = top
        self._sources = sources

    # One parameter

    def apply(self, xml: XmlElement) -> None:
        tag, element_id, action = written_tag(xml), xml.get('element_id'), xml.get('action')
        if element_id is None:
            self._sources.error(AttributeMissingError, xml, f'<{tag}> has no element_id')
        elif element_id.endswith(SEPARATOR):
            msg = f'element_id="{element_id}" ends with "{SEPARATOR}"; a name has to follow'
            self._sources.error(AttributeInvalidError, xml, msg)
        elif action not in (None, *_ACTIONS):
            self._report_action(xml)
        elif action == 'add':
            self._add(xml, tag, element_id)
        elif (target := element_by_id(self._top, element_id, tag)) is None:
            msg = (f'the included model has no <{tag}> "{element_id}"'
                   f'{self._hint(element_id, tag)}')
            self._sources.error(ElementMissingError, xml, msg)
        elif action in ('modify', 'remove') or self._is_defined(xml):
            if action is not None:
                self._perform(action, xml, target)
                return
            for child in child_elements(xml):
                self._change_child(child, tag, target)

    def _perform(self, action: str, xml: XmlElement, target: XmlElement) -> None:
        acts = {'modify': self._modify, 'remove': self._remove, 'replace': self._replace}
        acts[action](xml, target)

    def _add(self, xml: XmlElement, tag: str, element_id: str) -> None:
        name = xml.get('name')
        scoped = f'{element_id}{SEPARATOR}{name}'
        if not name:
            missing = AttributeMissingError if name is None else AttributeInvalidError
            self._sources.error(missing, xml, f'<{tag}> is to be added, so it needs a name')
        elif tag != 'plugin' and element_by_id(self._top, scoped, tag) is not None:
            msg = f'<{tag}> cannot be added: the included model has a <{tag}> "{scoped}" already'
            self._sources.error(DuplicateNameError, xml, msg)
        elif (parent := element_by_id(self._top, element_id) if element_id else self._top) is None:
            msg = (f'<{tag}> cannot be added to element_id="{element_id}": the included model has '
                   f'no such element{self._hint(element_id)}')
            self._sources.error(ElementMissingError, xml, msg)
        elif self._is_defined(xml):
            parent.append(self._new_element(xml))

    def _change_child(self, xml: XmlElement, parent_tag: str, target: XmlElement) -> None:
        tag, action = written_tag(xml), xml.get('action')
        if action is None:
            msg = f'<{tag}> has no action; it must have one, as <{parent_tag}> has none'
            self._sources.error(AttributeMissingError, xml, msg)
        elif action not in _ACTIONS:
            self._report_action(xml)
        elif action in ('add', 'replace') and tag not in _standalone_definition(
                parent_tag).children:
            msg = f'SDFormat defines no <{tag}> in a <{parent_tag}>'
            self._sources.error(ElementInvalidError, xml, msg)
        elif action == 'add' and tag == 'include':
            self._sources.warning(xml, 'an <include> that is added by itself includes nothing')
        elif action == 'add':
            target.append(self._new_element(xml))
        elif (found := self._child(target, xml, takes_first=action == 'modify')) is not None:
            self._perform(action, xml, found)

    # Actions

    def _new_element(self, xml: XmlElement) -> XmlElement:
        """Copy an element without attributes that are not defined, as libsdformat does."""
        self._sources.count_copy(xml, xml)
        element = copy_of(xml)
        definition = _definition_of_parameter(xml)
        attributes = element.keys()
        for attribute in attributes:
            if attribute in _OWN_ATTRIBUTES or (
                    attribute not in definition.attributes and ':' not in attribute):
                del element.attrib[attribute]
        self._sources.set_source(element, xml)
        is_valid_element(element, definition, self._sources)
        self.added.append(element)
        return element

    def _replace(self, xml: XmlElement, target: XmlElement) -> None:
        parent = target.getparent()
        if target.get('name') is not None and xml.get('name') is None:
            msg = f'<{written_tag(xml)}> is to replace {_start_tag(target)}, so it needs a name'
            self._sources.error(AttributeMissingError, xml, msg)
        elif parent is not None:
            parent.replace(target, self._new_element(xml))

    def _remove(self, xml: XmlElement, target: XmlElement) -> None:
        parent = target.getparent()
        if _is_empty(xml) and parent is not None:
            parent.remove(target)
        for child in child_elements(xml):
            found = self._child(target, child)
            if found is not None:
                target.remove(found)

    def _modify(
        self, xml: XmlElement, target: XmlElement, *, is_read_before: bool = False,
    ) -> None:
        """
        Change an element, and the children that a parameter has.

        :param is_read_before: whether a new text is read before the new attributes.
        """
        text = text_of(xml)
        has_text = bool(text.strip())
        self._change(
            xml, target, text if has_text and self._holds_value(target) else None,
            is_read_before=is_read_before or not has_text)
        if not has_text:
            for child in child_elements(xml):
                self._modify_child(child, target)

    def _modify_child(self, xml: XmlElement, target: XmlElement) -> None:
        found = self._child(target, xml, takes_first=True)
        if found is None:
            return
        if not _is_empty(xml):
            self._modify(xml, found, is_read_before=True)
        elif self._holds_value(found):
            is_end = written_tag(target) == 'joint' and found.tag in ('parent', 'child')
            definition = self._definition(found)
            if definition is not None and definition.is_required and not is_end:
                # Without the element, its default applies.
                target.remove(found)
                return
            self._change(xml, found, DEFAULT_END if is_end else '', is_read_before=False)
        else:
            msg = f'<{written_tag(xml)}> holds nothing, so it changes nothing'
            self._sources.warning(xml, msg)

    def _change(
        self, xml: XmlElement, target: XmlElement, text: str | None, *, is_read_before: bool,
    ) -> None:
        """
        Change the attributes of an element to those of a parameter.

        :param text: its new text; None to keep the old one.
        :param is_read_before: whether its text is read before its attributes change. Then those
            of the format of a pose are for the next text.
        """
        is_changed = text is not None
        if is_changed:
            target.attrib.update(dict(self._sources.origin(target).next_attributes))
            target[:] = []
            target.text = text
        definition = self._definition(target)
        attributes = {
            name: str(value) for name, value in xml.attrib.items()
            if name not in _OWN_ATTRIBUTES and ':' not in name}
        for name, value in attributes.items():
            if name not in target.attrib and (
                    definition is None or name not in definition.attributes):
                msg = f'SDFormat defines no attribute {name} of <{written_tag(target)}>'
                self._sources.error(AttributeInvalidError, xml, msg)
            elif (is_read_before and name in _POSE_FORMAT_ATTRIBUTES and target.tag == 'pose'
                    and text_of(target).strip()):
                self._keep_for_next_text(name, value, xml, target)
            else:
                target.set(name, value)
                is_changed = True
        if is_changed:
            self._set_source(target, xml)
            if definition is not None:
                is_valid_element(target, definition, self._sources)

    def _keep_for_next_text(
        self, name: str, value: str, xml: XmlElement, target: XmlElement,
    ) -> None:
        if target.get(name) != value:
            msg = (f'{name}="{value}" has no effect: libsdformat has read the numbers of this '
                   'pose before')
            self._sources.warning(xml, msg)
        kept = self._sources.origin(target).next_attributes
        self._sources.set_origin(target, next_attributes={**kept, name: value})

    def _set_source(self, target: XmlElement, xml: XmlElement) -> None:
        """Move the place of an element, and of ancestors up to that with the id, to the params."""
        path = self._sources.path(xml)
        while True:
            for child in child_elements(target):
                self._sources.set_origin(child, file=self._sources.path(child))
            parts = (part for child in child_elements(target, *_PARTS)
                     for part in child.iter(etree.Element))
            for part in (target, *parts):
                if self._sources.path(part) != path:
                    self._sources.set_source(part, xml)
            parent, above = target.getparent(), xml.getparent()
            if parent is None or above is None or xml.get('element_id') is not None:
                return
            target, xml = parent, above

    # Look-ups

    def _child(
        self, parent: XmlElement, xml: XmlElement, *, takes_first: bool = False,
    ) -> XmlElement | None:
        """Find the child with the tag and the name of a parameter; report it if there is none."""
        tag, name = written_tag(xml), xml.get('name')
        children = [child for child in child_elements(parent) if written_tag(child) == tag]
        definition = self._definition(parent)
        if not children and definition is not None and tag in definition.required_children:
            children = [etree.SubElement(parent, tag)]
            self._sources.set_source(children[0], xml)
        if name is None and children and children[0].get('name') is not None:
            self._sources.warning(xml, f'<{tag}> has no name; {_start_tag(children[0])} is taken')
        same = [child for child in children if name is None or child.get('name') == name]
        found = same[:1] or (children[:1] if takes_first else [])
        if found:
            return found[0]
        msg = f'{_start_tag(parent)} of the included model has no {_start_tag(xml)}'
        self._sources.error(ElementMissingError, xml, msg)
        return None

    def _definition(self, xml: XmlElement) -> Definition | None:
        """Return the definition of an element of the included model; None if there is none."""
        parent = xml.getparent()
        if parent is None:
            return definition_of(str(xml.tag))
        definition = self._definition(parent)
        return None if definition is None else definition.children.get(str(xml.tag))

    def _holds_value(self, xml: XmlElement) -> bool:
        definition = self._definition(xml)
        return definition is None or definition.value_type is not None

    # Errors

    def _hint(self, element_id: str, tag: str = '') -> str:
        problems = self._sources.problems
        return hint_for_id(self._top, element_id, tag) if problems.allows_hint() else ''

    def _report_action(self, xml: XmlElement) -> None:
        msg = f'action="{xml.get("action")}" must be one of {", ".join(_ACTIONS)}'
        self._sources.error(AttributeInvalidError, xml, msg)

    def _is_defined(self, xml: XmlElement) -> bool:
        tag = written_tag(xml)
        if tag not in STANDALONE_ELEMENTS:
            msg = f'<{tag}> is not an element that SDFormat defines by itself'
            self._sources.error(ElementInvalidError, xml, msg)
        return tag in STANDALONE_ELEMENTS


def _definition_of_parameter(xml: XmlElement) -> Definition:
    """Return the definition of an element to add, or of a child to add to another element."""
    tag, parent = written_tag(xml), xml.getparent()
    if tag in STANDALONE_ELEMENTS or parent is None:
        return _standalone_definition(tag)
    return _standalone_definition(written_tag(parent)).children[tag]


def _standalone_definition(tag: str) -> Definition:
    return definition_of(STANDALONE_ELEMENTS[tag])


def _start_tag(xml: XmlElement) -> str:
    tag, name = written_tag(xml), xml.get('name')
    return f'<{tag}>' if name is None else f'<{tag} name="{name}">'


def _is_empty(xml: XmlElement) -> bool:
    return len(xml) == 0 and not (xml.text or '').strip()
