# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Read one ``<include>``: what it stands for, and what it says differently."""

from __future__ import annotations

from typing import NamedTuple

from sdf_pose_bridge.errors import AttributeInvalidError
from sdf_pose_bridge.errors import AttributeMissingError
from sdf_pose_bridge.errors import ElementIncorrectTypeError
from sdf_pose_bridge.errors import ElementInvalidError
from sdf_pose_bridge.errors import ElementMissingError
from sdf_pose_bridge.errors import PlacementFrameError
from sdf_pose_bridge.errors import ReservedNameError
from sdf_pose_bridge.errors import UriLookupError
from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.sdformat.document import boolean_from_text
from sdf_pose_bridge.sdformat.document import Document
from sdf_pose_bridge.sdformat.document import value_of
from sdf_pose_bridge.sdformat.document import WHITE_SPACE
from sdf_pose_bridge.sdformat.document import XmlElement
from sdf_pose_bridge.sdformat.element_builder import ElementBuilder
from sdf_pose_bridge.sdformat.include.inclusion import Inclusion
from sdf_pose_bridge.sdformat.include.inclusion import TOP_TAGS
from sdf_pose_bridge.sdformat.include.inclusion import tops_of


class Include(NamedTuple):
    """An ``<include>`` and what it stands for."""

    xml: XmlElement
    document: Document
    """The file that it includes."""
    top: XmlElement
    """The model, light or actor at the top of that file."""
    name: str
    """What it is to be called: as the include says, else as the file does."""
    has_pose: bool
    """Whether the include says where it is, which replaces what the file says."""
    is_static: bool | None
    """What the include says of it; None for nothing."""
    placement_frame: str
    """The frame that the include's pose places; empty for what the file says."""
    is_merge: bool


def include_from_xml(
    xml: XmlElement,
    inclusion: Inclusion,
    table: ElementBuilder,
    parent: int,
    *,
    skips_missing: bool,
) -> Include | None:
    """
    Read an ``<include>``.

    :param xml: the element.
    :param inclusion: the file that was found for it.
    :param table: takes what is wrong with it.
    :param parent: index of the element that holds it.
    :param skips_missing: whether what cannot be found is only warned about.
    :return: what it says, or None if there is nothing to include, which is then reported.
    """
    return _IncludeReader(xml, inclusion, table, parent).include(skips_missing=skips_missing)


class _IncludeReader:

    def __init__(
        self, xml: XmlElement, inclusion: Inclusion, table: ElementBuilder, parent: int,
    ) -> None:
        self._xml = xml
        self._inclusion = inclusion
        self._table = table
        self._parent = parent

    def include(self, *, skips_missing: bool) -> Include | None:
        uri = self._uri()
        if uri is None:
            return None
        for warning in self._inclusion.warnings:
            self._table.note_warning(warning)
        for error in self._inclusion.errors:
            self._table.note_error(error)
        document = self._inclusion.document
        if self._inclusion.error is not None:
            self._table.note_error(self._inclusion.error)
            self._leave_out(uri)
            return None
        if document is None:
            self._report_missing(uri, skips_missing=skips_missing)
            return None
        top = self._top(document)
        if top is None:
            return None
        placement = self._value('placement_frame')
        if placement and next(self._xml.iterchildren('pose'), None) is None:
            msg = (f'<placement_frame> "{placement}" needs a <pose> in the same include, which '
                   'says where that frame is')
            self._table.error(PlacementFrameError, self._xml, msg, self._parent, 'include')
            placement = ''
        if placement == ROOT_FRAME:
            msg = f'"{placement}" is reserved; it cannot be a placement frame'
            self._table.error(ReservedNameError, self._xml, msg, self._parent, 'include')
            placement = ''
        return Include(
            xml=self._xml,
            document=document,
            top=top,
            name=self._value('name') or top.get('name', '').strip(WHITE_SPACE),
            has_pose=next(self._xml.iterchildren('pose'), None) is not None,
            is_static=self._static(),
            placement_frame=placement,
            is_merge=self._is_merge(),
        )

    def _uri(self) -> str | None:
        element = next(self._xml.iterchildren('uri'), None)
        if element is None:
            msg = 'the include has no <uri>, so it includes nothing'
            self._table.error(AttributeMissingError, self._xml, msg, self._parent, 'include')
            return None
        uri = value_of(element)
        if not uri:
            msg = 'the <uri> of the include is empty'
            self._table.error(ElementInvalidError, element, msg, self._parent, 'include/uri')
            return None
        return uri

    def _report_missing(self, uri: str, *, skips_missing: bool) -> None:
        msg = f'"{uri}" cannot be included: {self._inclusion.reason}'
        is_first = self._leave_out(uri)
        if skips_missing and is_first:
            msg = f'{msg}; it is left out'
            self._table.warning(self._xml, msg, self._parent, 'include/uri')
        elif not skips_missing:
            self._table.error(UriLookupError, self._xml, msg, self._parent, 'include/uri')

    def _leave_out(self, uri: str) -> bool:
        name = '' if self._is_merge() else self._value('name') or _name_from_uri(uri)
        return self._table.leave_out(self._parent, name, uri)

    def _top(self, document: Document) -> XmlElement | None:
        tops = tops_of(document)
        if not tops:
            msg = f'{document.path} cannot be included: no model, light or actor is at its top'
            self._table.error(ElementMissingError, self._xml, msg, self._parent, 'include/uri')
            return None
        if len(tops) > 1:
            names = ', '.join(self._table.described(xml) for xml in tops)
            msg = f'{document.path} has more than one element at its top: {names}'
            self._table.error(
                ElementIncorrectTypeError, self._xml, msg, self._parent, 'include/uri')
        top = min(tops, key=lambda xml: TOP_TAGS.index(str(xml.tag)))
        if top not in document.origins:  # what is included there is placed where this is included
            with self._table.reading(document):
                self._table.check_top_pose(top, self._parent)
        return top

    def _value(self, tag: str) -> str:
        element = next(self._xml.iterchildren(tag), None)
        if element is None:
            return ''
        value = value_of(element)
        if not value:
            msg = f'<{tag}> of the include is empty'
            self._table.error(ElementInvalidError, element, msg, self._parent, f'include/{tag}')
        return value

    def _static(self) -> bool | None:
        element = next(self._xml.iterchildren('static'), None)
        if element is None:
            return None
        value = boolean_from_text(value_of(element))
        if value is None:
            msg = f'"{value_of(element)}" is no boolean; it must be true, false, 1 or 0'
            self._table.error(ElementInvalidError, element, msg, self._parent, 'include/static')
        return value

    def _is_merge(self) -> bool:
        text = self._xml.get('merge', 'false')
        value = boolean_from_text(text)
        if value is None:
            msg = f'merge="{text}" is no boolean; it must be true, false, 1 or 0'
            self._table.error(AttributeInvalidError, self._xml, msg, self._parent, 'include')
        return bool(value)


def _name_from_uri(uri: str) -> str:
    """Guess what a model that cannot be found is called: mostly as its directory is."""
    steps = [part for part in uri.split('/') if part]
    if len(steps) > 1 and steps[-1].endswith(('.sdf', '.world', '.urdf')):
        steps.pop()
    return steps[-1] if steps else ''
