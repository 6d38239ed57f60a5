# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Change an included file as the parameters of its include say.

``<experimental:params>`` names elements of the included file by ``element_id``, and says by
``action`` what becomes of each: of the whole element, or of its children one by one.
"""

from __future__ import annotations

import copy
from typing import NamedTuple

from lxml import etree

from sdf_pose_bridge.errors import AttributeInvalidError
from sdf_pose_bridge.errors import AttributeMissingError
from sdf_pose_bridge.errors import DuplicateNameError
from sdf_pose_bridge.errors import ElementInvalidError
from sdf_pose_bridge.errors import ElementMissingError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.sdformat.document import Document
from sdf_pose_bridge.sdformat.document import set_line
from sdf_pose_bridge.sdformat.document import text_of
from sdf_pose_bridge.sdformat.document import XmlElement
from sdf_pose_bridge.sdformat.elements import step
from sdf_pose_bridge.sdformat.include.element_ids import ElementIds
from sdf_pose_bridge.sdformat.include.element_ids import written_tag
from sdf_pose_bridge.sdformat.include.expansion import Expansion
from sdf_pose_bridge.sdformat.include.inclusion import TOP_TAGS
from sdf_pose_bridge.sdformat.include.inclusion import tops_of
from sdf_pose_bridge.sdformat.include.params_grammar import CHILDREN
from sdf_pose_bridge.sdformat.include.params_grammar import DEFAULT_CHILDREN
from sdf_pose_bridge.sdformat.include.params_grammar import DEFINED
from sdf_pose_bridge.sdformat.include.params_grammar import has_attribute
from sdf_pose_bridge.sdformat.include.params_grammar import has_value

_PARAMS = 'experimental:params'
_OWN_ATTRIBUTES = ('element_id', 'action')
_ACTIONS = ('add', 'modify', 'remove', 'replace')
_HOW_TO_READ = frozenset({'degrees', 'rotation_format'})
_PARTS = ('pose', 'parent', 'child', 'axis', 'axis2')
"""What an element says of itself, in whose file it therefore stands."""

_NO_FRAME = '__default__'
"""What a joint's parent or child is called where no value is given."""


class Changes(NamedTuple):
    """What came of parameters."""

    errors: tuple[SdfError, ...]
    warnings: tuple[SdfWarning, ...]


def params_of(include: XmlElement) -> XmlElement | None:
    """
    Return the parameters of an include.

    :param include: the element.
    :return: its first ``<experimental:params>``; None if it has none.
    """
    return next(
        (xml for xml in include.iterchildren(etree.Element) if written_tag(xml) == _PARAMS), None)


def apply_params(params: XmlElement, expansion: Expansion, source: Document) -> Changes:
    """
    Change an included file.

    :param params: the ``<experimental:params>``; it is not changed.
    :param expansion: the file, which is changed; its ``origins`` tell afterwards what was.
    :param source: the file that the parameters stand in.
    :return: what is wrong with the parameters. What has an error is left as it is.
    """
    tops = tops_of(expansion.document)
    if not tops:
        return Changes((), ())
    top = min(tops, key=lambda xml: TOP_TAGS.index(str(xml.tag)))
    changer = _Changer(expansion, top, source)
    for xml in params.iterchildren(etree.Element):
        changer.apply(xml)
    return Changes(tuple(changer.errors), tuple(changer.warnings))


class _Changer:

    def __init__(self, expansion: Expansion, top: XmlElement, source: Document) -> None:
        self.errors: list[SdfError] = []
        self.warnings: list[SdfWarning] = []
        self._ids = ElementIds(expansion, top)
        self._origins = expansion.origins
        self._document = expansion.document
        self._source = source

    # One element of the parameters

    def apply(self, xml: XmlElement) -> None:
        tag = written_tag(xml)
        element_id = xml.get('element_id')
        if element_id is None:
            self._error(AttributeMissingError, xml, f'<{tag}> has no element_id')
            return
        if element_id.endswith(SEPARATOR):
            msg = f'element_id="{element_id}" ends with "{SEPARATOR}"; a name has to follow'
            self._error(AttributeInvalidError, xml, msg)
            return
        action = xml.get('action')
        if action is None:
            self._change_children(xml, tag, element_id)
        elif action == 'add':
            self._add(xml, tag, element_id)
        elif self._is_action(xml, action):
            target = self._target(xml, tag, element_id)
            if target is not None:
                self._act(action, xml, tag, target)

    def _act(self, action: str, xml: XmlElement, tag: str, target: XmlElement) -> None:
        if action == 'modify':
            self._modify(xml, target)
        elif action == 'remove':
            self._remove(xml, target)
        elif self._is_defined(xml, tag):
            self._replace(xml, tag, target)

    def _add(self, xml: XmlElement, tag: str, element_id: str) -> None:
        name = xml.get('name')
        if not name:
            missing = AttributeMissingError if name is None else AttributeInvalidError
            self._error(missing, xml, f'<{tag}> is to be added, so it needs a name')
            return
        scoped = f'{element_id}{SEPARATOR}{name}'
        if tag != 'plugin' and self._ids.element(scoped, tag) is not None:
            msg = f'<{tag}> cannot be added: the included model has a <{tag}> "{scoped}" already'
            self._error(DuplicateNameError, xml, msg)
            return
        holder = self._ids.holder(element_id)
        if holder is None:
            msg = (f'<{tag}> cannot be added to element_id="{element_id}": the included model has '
                   f'no such element{self._ids.hint(element_id, "")}')
            self._error(ElementMissingError, xml, msg)
        elif self._is_defined(xml, tag):
            holder.append(self._new_element(xml))

    def _change_children(self, xml: XmlElement, tag: str, element_id: str) -> None:
        target = self._target(xml, tag, element_id)
        if target is None or not self._is_defined(xml, tag):
            return
        for child in xml.iterchildren(etree.Element):
            action = child.get('action')
            if action is None:
                msg = (f'<{written_tag(child)}> has no action; it must have one, as <{tag}> has '
                       'none')
                self._error(AttributeMissingError, child, msg)
            elif self._is_action(child, action):
                self._change_child(child, action, target)

    def _change_child(self, xml: XmlElement, action: str, target: XmlElement) -> None:
        tag, target_tag = written_tag(xml), written_tag(target)
        if action in ('add', 'replace') and tag not in CHILDREN.get(target_tag, ()):
            msg = f'SDFormat knows no <{tag}> in a <{target_tag}>'
            self._error(ElementInvalidError, xml, msg)
            return
        if action == 'add' and tag == 'include':
            self._warning(xml, 'an <include> that is added by itself includes nothing')
            return
        if action == 'add':
            target.append(self._new_element(xml))
            return
        found = self._child(target, xml, takes_first=action == 'modify')
        if found is None:
            self._error(ElementMissingError, xml, self._missing_child(xml, target))
        elif action == 'replace':
            self._replace(xml, tag, found)
        else:
            self._act(action, xml, tag, found)

    # Actions

    def _new_element(self, xml: XmlElement) -> XmlElement:
        element = copy.deepcopy(xml)
        element.tail = None
        for attribute in _OWN_ATTRIBUTES:
            element.attrib.pop(attribute, None)
        self._origins[element] = self._source
        return element

    def _replace(self, xml: XmlElement, tag: str, target: XmlElement) -> None:
        holder = target.getparent()
        if target.get('name') is not None and xml.get('name') is None:
            msg = f'<{tag}> is to replace <{tag} name="{target.get("name")}">, so it needs a name'
            self._error(AttributeMissingError, xml, msg)
        elif holder is not None:
            holder.replace(target, self._new_element(xml))

    def _remove(self, xml: XmlElement, target: XmlElement) -> None:
        if _is_empty(xml):
            _take_out(target)
            return
        for child in xml.iterchildren(etree.Element):
            found = self._child(target, child, takes_first=False)
            if found is None:
                self._error(ElementMissingError, child, self._missing_child(child, target))
            else:
                _take_out(found)

    def _modify(self, xml: XmlElement, target: XmlElement) -> None:
        text = text_of(xml)
        has_text = bool(text.strip())
        # A text that comes with its attributes is read by them; one that stays is not read again.
        self._change_attributes(xml, target, is_read_before=not has_text)
        if not has_text:
            self._modify_children(xml, target)
        elif _holds_value(target):
            self._set_text(text, xml, target)

    def _modify_children(self, xml: XmlElement, target: XmlElement) -> None:
        for child in xml.iterchildren(etree.Element):
            found = self._child(target, child, takes_first=True)
            text = text_of(child)
            if found is None:
                self._error(ElementMissingError, child, self._missing_child(child, target))
            elif text.strip():
                if _holds_value(found):
                    self._set_text(text, child, found)
                # Unlike where a pose is changed by itself, its text has been read by now.
                self._change_attributes(child, found, is_read_before=True)
            elif not _is_empty(child):
                self._modify(child, found)
            elif _holds_value(found):
                is_end = written_tag(target) == 'joint' and found.tag in ('parent', 'child')
                self._set_text(_NO_FRAME if is_end else '', child, found)
                self._change_attributes(child, found, is_read_before=False)
            else:
                msg = f'<{written_tag(child)}> holds nothing, so it changes nothing'
                self._warning(child, msg)

    def _set_text(self, text: str, xml: XmlElement, target: XmlElement) -> None:
        for child in list(target):
            target.remove(child)
        target.text = text
        self._take_over(target, xml)

    def _change_attributes(
        self, xml: XmlElement, target: XmlElement, *, is_read_before: bool,
    ) -> None:
        tag, holder = written_tag(target), _holder_tag(target)
        for attribute, value in xml.attrib.items():
            if attribute in _OWN_ATTRIBUTES or ':' in attribute:
                continue
            if attribute not in target.attrib and not has_attribute(
                    holder, tag, attribute):
                msg = f'SDFormat knows no attribute {attribute} of <{tag}>'
                self._error(AttributeInvalidError, xml, msg)
            elif (tag == 'pose' and attribute in _HOW_TO_READ and is_read_before
                    and text_of(target).strip()):
                if target.get(attribute) != value:
                    msg = (f'{attribute}="{value}" comes too late: libsdformat has read the '
                           'numbers of this pose before')
                    self._warning(xml, msg)
            else:
                target.set(attribute, str(value))
                self._take_over(target, xml)

    def _take_over(self, target: XmlElement, xml: XmlElement) -> None:
        """Note that an element now stands in the parameters."""
        while True:
            for child in target.iterchildren(etree.Element):
                self._origins.setdefault(child, self._document.origin(child))
            parts = (
                part for child in target.iterchildren(*_PARTS)
                for part in child.iter(etree.Element))
            for part in (target, *parts):
                if self._origins.get(part) is not self._source:
                    self._origins[part] = self._source
                    set_line(part, xml.sourceline)
            holder, above = target.getparent(), xml.getparent()
            if holder is None or above is None or xml.get('element_id') is not None:
                return
            target, xml = holder, above

    # What is looked for

    def _target(self, xml: XmlElement, tag: str, element_id: str) -> XmlElement | None:
        target = self._ids.element(element_id, tag)
        if target is None:
            msg = (f'the included model has no <{tag}> "{element_id}"'
                   f'{self._ids.hint(element_id, tag)}')
            self._error(ElementMissingError, xml, msg)
        return target

    def _child(
        self, holder: XmlElement, xml: XmlElement, *, takes_first: bool,
    ) -> XmlElement | None:
        """Find the child that has the tag and the name of an element of the parameters."""
        tag, name = written_tag(xml), xml.get('name')
        children = [child for child in self._ids.children(holder) if written_tag(child) == tag]
        if not children and tag in DEFAULT_CHILDREN.get(written_tag(holder), ()):
            children = [etree.SubElement(holder, tag)]
            self._origins[children[0]] = self._source
            set_line(children[0], xml.sourceline)
        if name is None and children and children[0].get('name') is not None:
            msg = f'<{tag}> has no name; <{tag} name="{children[0].get("name")}"> is taken'
            self._warning(xml, msg)
        if name is None:
            return children[0] if children else None
        same = (child for child in children if child.get('name') == name)
        return next(same, children[0] if children and takes_first else None)

    def _missing_child(self, xml: XmlElement, holder: XmlElement) -> str:
        tag, name = written_tag(xml), xml.get('name')
        wanted = f'<{tag}>' if name is None else f'<{tag} name="{name}">'
        holder_name = holder.get('name')
        label = written_tag(holder) if holder_name is None else (
            f'{written_tag(holder)} name="{holder_name}"')
        return f'<{label}> of the included model has no {wanted}'

    # What is wrong

    def _is_action(self, xml: XmlElement, action: str) -> bool:
        if action in _ACTIONS:
            return True
        msg = f'action="{action}" must be one of {", ".join(_ACTIONS)}'
        self._error(AttributeInvalidError, xml, msg)
        return False

    def _is_defined(self, xml: XmlElement, tag: str) -> bool:
        if tag in DEFINED:
            return True
        msg = f'<{tag}> is none of the elements that SDFormat defines by themselves'
        self._error(ElementInvalidError, xml, msg)
        return False

    def _error(self, error_class: type[SdfError], xml: XmlElement, message: str) -> None:
        self.errors.append(error_class(message, self._place(xml)))

    def _warning(self, xml: XmlElement, message: str) -> None:
        self.warnings.append(SdfWarning('WARNING', message, self._place(xml)))

    def _place(self, xml: XmlElement) -> Place:
        steps = [_step(holder) for holder in (xml, *xml.iterancestors())]
        return Place(
            self._source.origin(xml).path, xml.sourceline or 0, '/' + '/'.join(reversed(steps)))


def _step(xml: XmlElement) -> str:
    element_id, name = xml.get('element_id'), xml.get('name')
    if element_id is not None:
        return f'{written_tag(xml)}[@element_id="{element_id}"]'
    return written_tag(xml) if name is None else step(written_tag(xml), name)


def _is_empty(xml: XmlElement) -> bool:
    return len(xml) == 0 and not (xml.text or '').strip()


def _holder_tag(xml: XmlElement) -> str:
    holder = xml.getparent()
    return '' if holder is None else written_tag(holder)


def _holds_value(xml: XmlElement) -> bool:
    return has_value(_holder_tag(xml), written_tag(xml))


def _take_out(xml: XmlElement) -> None:
    holder = xml.getparent()
    if holder is not None:
        holder.remove(xml)
