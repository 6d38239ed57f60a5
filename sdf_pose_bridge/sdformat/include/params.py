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
from sdf_pose_bridge.geometry.pose_attributes import FORMAT_ATTRIBUTES
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.sdformat.element_reader import ElementReader
from sdf_pose_bridge.sdformat.grammar import (
    Definition,
    definition_of,
    Kind,
    PARTS_OF_MODEL,
    STANDALONE_ELEMENTS,
)
from sdf_pose_bridge.sdformat.include.element_ids import ElementIds, hint_for_id
from sdf_pose_bridge.sdformat.joints import DEFAULT_END
from sdf_pose_bridge.sdformat.sources import PARAMS_TAG, Sources
from sdf_pose_bridge.sdformat.xml_tree import (
    child_elements,
    copy_of,
    text_of,
    with_ancestors,
    written_tag,
    XmlElement,
)

TOP_TAGS = [kind.label for kind in Kind if 'sdf' in kind.parents and kind is not Kind.WORLD]
"""The tags of elements that can be included, in the order of preference."""
_OWN_ATTRIBUTES = ('element_id', 'action')
_ACTIONS = ('add', 'modify', 'remove', 'replace')
_PARTS = {
    path.partition('/')[0] for part in PARTS_OF_MODEL.values() for path, _ in part.references}
"""Child elements with references, which are defined in the file of their parent element."""


def apply_params(
    include: XmlElement, top: XmlElement, sources: Sources, reader: ElementReader,
) -> list[XmlElement]:
    """
    Change an included element by the first ``<experimental:params>`` of its include.

    :param sources: takes errors and warnings. A parameter with an error is not applied.
    :param reader: checks the elements that are changed.
    :return: the elements that were added.
    """
    params = next((xml for xml in child_elements(include) if written_tag(xml) == PARAMS_TAG), None)
    if params is None:
        return []
    changer = _Changer(top, sources, reader)
    for xml in child_elements(params):
        changer.apply(xml)
    return changer.added


class _Changer:

    def __init__(self, top: XmlElement, sources: Sources, reader: ElementReader) -> None:
        self.added: list[XmlElement] = []
        self._top = top
        self._ids = ElementIds(top)
        self._sources = sources
        self._reader = reader
        self._error = sources.error
        self._actions = {'modify': self._modify, 'remove': self._remove, 'replace': self._replace}

    # One parameter

    def apply(self, xml: XmlElement) -> None:
        tag, element_id, action = written_tag(xml), xml.get('element_id'), xml.get('action')
        if element_id is None:
            self._error(AttributeMissingError, xml, f'<{tag}> has no element_id')
        elif element_id.endswith(SEPARATOR):
            msg = f'element_id="{element_id}" ends with "{SEPARATOR}"; a name has to follow'
            self._error(AttributeInvalidError, xml, msg)
        elif action not in (None, *_ACTIONS):
            self._report_action(xml)
        elif action == 'add':
            self._add(xml, tag, element_id)
        elif (target := self._ids.element(element_id, tag)) is None:
            hint = hint_for_id(self._top, element_id, self._sources.problems, tag)
            msg = f'the included model has no <{tag}> "{element_id}"{hint}'
            self._error(ElementMissingError, xml, msg)
        elif action in ('modify', 'remove') or self._is_defined(xml):
            if action is not None:
                self._actions[action](xml, target)
                return
            for child in child_elements(xml):
                self._change_child(child, tag, target)

    def _add(self, xml: XmlElement, tag: str, element_id: str) -> None:
        name = xml.get('name')
        scoped = f'{element_id}{SEPARATOR}{name}'
        if not name:
            missing = AttributeMissingError if name is None else AttributeInvalidError
            self._error(missing, xml, f'<{tag}> is to be added, so it needs a name')
        elif tag != 'plugin' and self._ids.element(scoped, tag) is not None:
            msg = f'<{tag}> cannot be added: the included model has a <{tag}> "{scoped}" already'
            self._error(DuplicateNameError, xml, msg)
        elif (parent := self._ids.element(element_id) if element_id else self._top) is None:
            hint = hint_for_id(self._top, element_id, self._sources.problems)
            msg = (f'<{tag}> cannot be added to element_id="{element_id}": the included model has '
                   f'no such element{hint}')
            self._error(ElementMissingError, xml, msg)
        elif self._is_defined(xml):
            self._append(self._new_element(xml), parent)

    def _change_child(self, xml: XmlElement, parent_tag: str, target: XmlElement) -> None:
        tag, action = written_tag(xml), xml.get('action')
        if action is None:
            msg = f'<{tag}> has no action; it must have one, as <{parent_tag}> has none'
            self._error(AttributeMissingError, xml, msg)
        elif action not in _ACTIONS:
            self._report_action(xml)
        elif action in ('add', 'replace') and tag not in _standalone_definition(
                parent_tag).children:
            msg = f'SDFormat defines no <{tag}> in a <{parent_tag}>'
            self._error(ElementInvalidError, xml, msg)
        elif action == 'add' and tag == 'include':
            self._sources.warning(xml, 'an <include> that is added by itself includes nothing')
        elif action == 'add':
            self._append(self._new_element(xml), target)
        elif (found := self._child(target, xml, takes_first=action == 'modify')) is not None:
            self._actions[action](xml, found)

    # Actions

    def _new_element(self, xml: XmlElement) -> XmlElement:
        """Copy an element without attributes that are not defined, as libsdformat does."""
        self._sources.count_copy(xml, xml)
        element = copy_of(xml)
        tag, parent = written_tag(xml), xml.getparent()
        if tag in STANDALONE_ELEMENTS or parent is None:
            definition = _standalone_definition(tag)
        else:
            definition = _standalone_definition(written_tag(parent)).children[tag]
        for attribute in element.keys():  # noqa: SIM118  # it is changed
            if attribute in _OWN_ATTRIBUTES or (
                    attribute not in definition.attributes and ':' not in attribute):
                del element.attrib[attribute]
        self._sources.set_source(element, xml)
        self._reader.is_valid(element, definition)
        self.added.append(element)
        return element

    def _append(self, xml: XmlElement, parent: XmlElement) -> None:
        parent.append(xml)
        self._ids.add(xml)

    def _replace(self, xml: XmlElement, target: XmlElement) -> None:
        parent = target.getparent()
        if target.get('name') is not None and xml.get('name') is None:
            msg = f'<{written_tag(xml)}> is to replace {_start_tag(target)}, so it needs a name'
            self._error(AttributeMissingError, xml, msg)
        elif parent is not None:
            new = self._new_element(xml)
            parent.replace(target, new)
            self._ids.add(new, in_place_of=target)

    def _remove(self, xml: XmlElement, target: XmlElement) -> None:
        parent = target.getparent()
        if _is_empty(xml) and parent is not None:
            parent.remove(target)
        for child in child_elements(xml):
            found = self._child(target, child)
            if found is not None:
                target.remove(found)

    def _modify(self, xml: XmlElement, target: XmlElement) -> None:
        text = text_of(xml)
        self._change(xml, target, text if text and _holds_value(target) else None)
        if not text:
            for child in child_elements(xml):
                self._modify_child(child, target)

    def _modify_child(self, xml: XmlElement, target: XmlElement) -> None:
        found = self._child(target, xml, takes_first=True)
        if found is None:
            return
        if not _is_empty(xml):
            self._modify(xml, found)
        elif _holds_value(found):
            is_end = written_tag(target) == 'joint' and found.tag in ('parent', 'child')
            definition = definition_in_tree(found)
            if definition is not None and definition.is_required and not is_end:
                # Without the element, its default applies.
                target.remove(found)
                return
            self._change(xml, found, DEFAULT_END if is_end else '')
        else:
            msg = f'<{written_tag(xml)}> holds nothing, so it changes nothing'
            self._sources.warning(xml, msg)

    def _change(self, xml: XmlElement, target: XmlElement, text: str | None) -> None:
        """
        Change the attributes of an element to those of a parameter, and its text if one is given.

        Only if the parameter itself has the action and a text, libsdformat reads the text with the
        new attributes. Otherwise those of the format of a pose are for its next text.
        """
        is_changed = text is not None
        is_read_before = text is None or xml.get('action') is None
        if is_changed:
            target.attrib.update(dict(self._sources.origin(target).next_attributes))
            target[:] = []
            target.text = text
        definition = definition_in_tree(target)
        attributes = {
            name: str(value) for name, value in xml.attrib.items()
            if name not in _OWN_ATTRIBUTES and ':' not in name}
        for name, value in attributes.items():
            if name not in target.attrib and (
                    definition is None or name not in definition.attributes):
                msg = f'SDFormat defines no attribute {name} of <{written_tag(target)}>'
                self._error(AttributeInvalidError, xml, msg)
            elif (is_read_before and name in FORMAT_ATTRIBUTES and target.tag == 'pose'
                    and text_of(target)):
                if target.get(name) != value:
                    msg = (f'{name}="{value}" has no effect: libsdformat has read the numbers of '
                           'this pose before')
                    self._sources.warning(xml, msg)
                kept = self._sources.origin(target).next_attributes
                self._sources.set_origin(target, next_attributes={**kept, name: value})
            else:
                target.set(name, value)
                is_changed = True
        if is_changed:
            if 'name' in attributes:
                self._ids.add(target, in_place_of=target)
            self._set_source(target, xml)
            if definition is not None:
                self._reader.is_valid(target, definition, with_children=False)

    def _set_source(self, target: XmlElement, xml: XmlElement) -> None:
        """Move the place of an element, and of ancestors up to that with the id, to the params."""
        path = self._sources.path(xml)
        while True:
            # Once it is in the file of the params, the content has files of its own.
            if self._sources.path(target) != path:
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
        first = self._ids.child(parent, tag)
        definition = definition_in_tree(parent) if first is None else None
        if definition is not None and tag in definition.required_children:
            first = etree.SubElement(parent, tag)
            self._ids.add(first)
            self._sources.set_source(first, xml)
        if name is None and first is not None and first.get('name') is not None:
            self._sources.warning(xml, f'<{tag}> has no name; {_start_tag(first)} is taken')
        found = first if name is None else self._ids.child(parent, tag, name)
        if found is None and takes_first:
            found = first
        if found is None:
            msg = f'{_start_tag(parent)} of the included model has no {_start_tag(xml)}'
            self._error(ElementMissingError, xml, msg)
        return found

    # Errors

    def _report_action(self, xml: XmlElement) -> None:
        msg = f'action="{xml.get("action")}" must be one of {", ".join(_ACTIONS)}'
        self._error(AttributeInvalidError, xml, msg)

    def _is_defined(self, xml: XmlElement) -> bool:
        tag = written_tag(xml)
        if tag not in STANDALONE_ELEMENTS:
            msg = f'<{tag}> is not an element that SDFormat defines by itself'
            self._error(ElementInvalidError, xml, msg)
        return tag in STANDALONE_ELEMENTS


def definition_in_tree(xml: XmlElement) -> Definition | None:
    """Return the definition of an element of a file or of an included element, if it has one."""
    top, *inner = reversed([*with_ancestors(xml)])
    definition = definition_of(str(top.tag)) if top.tag in ('sdf', *TOP_TAGS) else None
    for each in inner:
        definition = None if definition is None else definition.children.get(each.tag)
    return definition


def _holds_value(xml: XmlElement) -> bool:
    definition = definition_in_tree(xml)
    return definition is None or definition.value_type is not None


def _standalone_definition(tag: str) -> Definition:
    return definition_of(STANDALONE_ELEMENTS[tag])


def _start_tag(xml: XmlElement) -> str:
    tag, name = written_tag(xml), xml.get('name')
    return f'<{tag}>' if name is None else f'<{tag} name="{name}">'


def _is_empty(xml: XmlElement) -> bool:
    return len(xml) == 0 and not text_of(xml)
