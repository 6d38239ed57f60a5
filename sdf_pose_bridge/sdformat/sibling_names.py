# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Check the names of siblings: missing, reserved and duplicate ones.

Rules: pose semantics in SDFormat, section on names; ``isReservedName`` and the loading of Model,
World and Link in libsdformat.
"""

from __future__ import annotations

from itertools import chain, count

from sdf_pose_bridge.errors import (
    AttributeInvalidError,
    AttributeMissingError,
    DuplicateNameError,
    Place,
    ReservedNameError,
)
from sdf_pose_bridge.names import is_reserved, WORLD_FRAME
from sdf_pose_bridge.sdformat.elements import ElementsBuilder
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.versions import renames_duplicates
from sdf_pose_bridge.sdformat.xml_tree import attribute_of, XmlElement


class SiblingNames:
    """
    The used names, by parent element and kind.

    Links, joints, frames and models of one parent share a name space. Each other kind has its own.
    """

    def __init__(self, builder: ElementsBuilder, sources: Sources) -> None:
        self._builder = builder
        self._sources = sources
        self._used: dict[tuple[int, Kind | None, str], tuple[Kind, int, bool]] = {}
        """Kind, index, and whether the name is a new one, by parent, kind and name."""
        self._renamed: set[tuple[int, Kind, str]] = set()

    def add(self, kind: Kind, xml: XmlElement, parent: int, parent_path: str) -> str | None:
        """
        Add the name of the next element of the table.

        :param parent: index of its parent element; -1 for the file.
        :param parent_path: file of the parent element.
        :return: its name; below version 1.7, a new one if another kind of element has the name.
            None if the name is missing or in use, which is reported.
        """
        name = attribute_of(xml, 'name')
        if not name:
            self._report_no_name(kind, xml)
            return None
        if is_reserved(name) and kind is not Kind.ACTOR:
            self._report_reserved_name(xml, name)
        key = (parent, None if kind.is_frame else kind, name)
        if key not in self._used:
            self._used[key] = (kind, len(self._builder.names), False)
            return name
        other, index, is_new = self._used[key]
        has_duplicate = (other is kind and not is_new) or (
            (parent, kind, name) in self._renamed)
        if not has_duplicate and self._is_renamed(kind, parent, parent_path):
            self._renamed.add((parent, kind, name))
            return self._new_name(kind, xml, parent, name)
        path = self._sources.paths[self._builder.file_indices[index]]
        article = 'an' if other is Kind.ACTOR else 'a'
        msg = (f'the name "{name}" belongs to {article} {other.label} of this scope already, '
               f'see {Place(path, self._builder.lines[index])}')
        self._sources.error_in_name(DuplicateNameError, xml, msg)
        return None

    def _report_no_name(self, kind: Kind, xml: XmlElement) -> None:
        if xml.get('name') is None:
            msg = f'the {kind.label} has no name'
            self._sources.error_in_name(AttributeMissingError, xml, msg)
        else:
            msg = f'the name of the {kind.label} is empty'
            self._sources.error_in_name(AttributeInvalidError, xml, msg)

    def _report_reserved_name(self, xml: XmlElement, name: str) -> None:
        rule = ('it means the frame of the world' if name == WORLD_FRAME else
                'so are all that begin and end with two underscores')
        msg = f'the name "{name}" is reserved; {rule}'
        self._sources.error_in_name(ReservedNameError, xml, msg)

    def _is_renamed(self, kind: Kind, parent: int, parent_path: str) -> bool:
        if parent < 0 or not kind.is_frame or kind is Kind.MODEL:
            return False
        return renames_duplicates(self._sources.versions[parent_path]) and (
            self._builder.kinds[parent] == Kind.MODEL or kind is Kind.FRAME)

    def _new_name(self, kind: Kind, xml: XmlElement, parent: int, name: str) -> str:
        candidates = chain(
            [f'{name}_{kind.label}'], (f'{name}_{kind.label}{number}' for number in count()))
        new_name = next(
            each for each in candidates if (parent, None, each) not in self._used)
        self._used[parent, None, new_name] = (kind, len(self._builder.names), True)
        msg = (f'the name "{name}" is that of another kind of element in this scope; this '
               f'{kind.label} is called "{new_name}" instead, and references to "{name}" mean the '
               'other one')
        self._sources.warning(xml, msg)
        return new_name
