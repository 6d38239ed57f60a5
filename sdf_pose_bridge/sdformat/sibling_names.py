# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Check names: missing, reserved and duplicate ones of siblings, and those that hold ``::``.

Rules: pose semantics in SDFormat, section on names; ``isReservedName`` and the loading of Model,
World and Link in libsdformat.
"""

from __future__ import annotations

from itertools import count, takewhile

from sdf_pose_bridge.errors import (
    AttributeInvalidError,
    AttributeMissingError,
    DuplicateNameError,
    Place,
    ReservedNameError,
)
from sdf_pose_bridge.names import is_reserved, SEPARATOR, WORLD_FRAME
from sdf_pose_bridge.sdformat.elements import ElementsBuilder
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.versions import allows_scoped_names, renames_duplicates
from sdf_pose_bridge.sdformat.xml_tree import (
    attribute_of,
    is_foreign_itself,
    with_ancestors,
    XmlElement,
)


class SiblingNames:
    """
    The used names, by parent element and kind.

    Links, joints, frames and models of one parent share a name space. Each other kind has its own.
    """

    def __init__(self, builder: ElementsBuilder, sources: Sources) -> None:
        self._builder = builder
        self._sources = sources
        self._used: dict[tuple[int, Kind | None, str], tuple[Kind, int, bool]] = {}
        """Kind, index, and whether the element was renamed, by parent, kind and name. The kind in
        a key is None in the shared name space, except for a name that is replaced by a new one."""

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
            if xml.get('name') is None:
                msg = f'the {kind.label} has no name'
                self._sources.error_in_name(AttributeMissingError, xml, msg)
            else:
                msg = f'the name of the {kind.label} is empty'
                self._sources.error_in_name(AttributeInvalidError, xml, msg)
            return None
        if is_reserved(name) and kind is not Kind.ACTOR:
            rule = ('it means the frame of the world' if name == WORLD_FRAME else
                    'so are all that begin and end with two underscores')
            msg = f'the name "{name}" is reserved; {rule}'
            self._sources.error_in_name(ReservedNameError, xml, msg)
        key = (parent, None if kind.is_frame else kind, name)
        if key not in self._used:
            self._used[key] = (kind, len(self._builder.names), False)
            return name
        other, index, is_new = self._used[key]
        if (other is not kind or is_new) and (parent, kind, name) not in self._used and (
                self._is_renamed(kind, parent, parent_path)):
            self._used[parent, kind, name] = (kind, len(self._builder.names), False)
            return self._new_name(kind, xml, parent, name)
        path = self._sources.paths[self._builder.file_indices[index]]
        article = 'an' if other is Kind.ACTOR else 'a'
        msg = (f'the name "{name}" belongs to {article} {other.label} of this scope already, '
               f'see {Place(path, self._builder.lines[index])}')
        self._sources.error_in_name(DuplicateNameError, xml, msg)
        return None

    def _is_renamed(self, kind: Kind, parent: int, parent_path: str) -> bool:
        if parent < 0 or not kind.is_frame or kind is Kind.MODEL:
            return False
        return renames_duplicates(self._sources.versions[parent_path]) and (
            self._builder.kinds[parent] == Kind.MODEL or kind is Kind.FRAME)

    def _new_name(self, kind: Kind, xml: XmlElement, parent: int, name: str) -> str:
        new_name, numbers = f'{name}_{kind.label}', count()
        while (parent, None, new_name) in self._used:
            new_name = f'{name}_{kind.label}{next(numbers)}'
        self._used[parent, None, new_name] = (kind, len(self._builder.names), True)
        msg = (f'the name "{name}" is that of another kind of element in this scope; this '
               f'{kind.label} is called "{new_name}" instead, and references to "{name}" mean the '
               'other one')
        self._sources.warning(xml, msg)
        return new_name


def check_scoped_names(root: XmlElement, sources: Sources) -> None:
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
