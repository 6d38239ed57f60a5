# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Find the elements of an included file that parameters speak of.

An ``element_id`` joins names by ``::``, from the included model inwards. The search is that of
libsdformat, with what it cannot find: it goes from sibling to sibling, remembers the one whose
name is the longest beginning of the id, and looks on inside that one alone.
"""

from __future__ import annotations

from collections.abc import Iterator

from lxml import etree

from sdf_pose_bridge.errors import hint_from_names
from sdf_pose_bridge.names import scoped_name
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.sdformat.document import WHITE_SPACE
from sdf_pose_bridge.sdformat.document import XmlElement
from sdf_pose_bridge.sdformat.include.expansion import Expansion
from sdf_pose_bridge.sdformat.include.inclusion import is_merge
from sdf_pose_bridge.sdformat.include.inclusion import tops_of

_MERGED_TAGS = frozenset({'frame', 'gripper', 'joint', 'link', 'model', 'plugin'})


def written_tag(xml: XmlElement) -> str:
    """
    Return an element's tag as it is written.

    :param xml: any element.
    :return: with its prefix where it has one, be it declared or not.
    """
    tag = str(xml.tag)
    if not tag.startswith('{'):
        return tag
    local = tag[tag.index('}') + 1:]
    return f'{xml.prefix}:{local}' if xml.prefix else local


class ElementIds:
    """
    The search in one included file.

    :param expansion: the file, with what it includes in its place.
    :param top: the element that is included.
    """

    def __init__(self, expansion: Expansion, top: XmlElement) -> None:
        self._expansion = expansion
        self._top = top

    def children(self, xml: XmlElement) -> Iterator[XmlElement]:
        """
        Go through what an element holds.

        :param xml: an element of the file.
        :return: its child elements, with what it merges, and without what only speaks of another.
        """
        for child in xml.iterchildren(etree.Element):
            if child.tag != 'include':
                yield child
            elif is_merge(child) and child in self._expansion.inclusions:
                document = self._expansion.inclusions[child].document
                for top in tops_of(document)[:1] if document is not None else ():
                    yield from (
                        inner for inner in self.children(top)
                        if inner.tag in _MERGED_TAGS or ':' in written_tag(inner))

    def element(self, element_id: str, tag: str) -> XmlElement | None:
        """
        Find an element of a tag.

        :param element_id: names from the included element inwards.
        :param tag: its tag, as written.
        :return: the element, or None.
        """
        return self._search(element_id, tag)

    def holder(self, element_id: str) -> XmlElement | None:
        """
        Find the element that something is to be added to.

        :param element_id: names from the included element inwards; empty for that itself.
        :return: the element, of whatever tag, or None.
        """
        return self._search(element_id, '') if element_id else self._top

    def hint(self, element_id: str, tag: str) -> str:
        """
        Return the end of a sentence about an id that was not found.

        :param element_id: the id.
        :param tag: tag of the element that was looked for; empty for any.
        :return: why it may be, or which near id there is; else empty.
        """
        ids = list(self._ids(self._top, ''))
        same = [found_tag for found_id, found_tag in ids if found_id == element_id]
        if tag in same and len(element_id.split(SEPARATOR)[0]) == 1:
            return '; libsdformat does not find names of one letter at the top of a model'
        if tag in same:
            return f'; libsdformat finds only the <{same[0]}> of that name, which stands before it'
        if same:
            return f'; that is a <{same[0]}>'
        wanted = [found_id for found_id, found_tag in ids if tag in ('', found_tag)]
        return hint_from_names(element_id, wanted)

    def _search(self, element_id: str, tag: str) -> XmlElement | None:
        children = self.children(self._top)
        start = longest = 0
        while True:
            match: XmlElement | None = None
            for child in children:
                written = child.get('name')
                if written is None:
                    continue
                name = written.strip(WHITE_SPACE)
                if not tag and name == element_id:
                    return child
                last = start + len(name) - 1
                if last <= longest or not element_id.startswith(name, start):
                    continue
                if element_id[start:] == name and tag in ('', written_tag(child)):
                    return child
                match, longest = child, last
            if match is None:
                return None
            children = self.children(match)
            start = longest
            if element_id.startswith(SEPARATOR, start + 1):
                start += 1 + len(SEPARATOR)

    def _ids(self, xml: XmlElement, scope: str) -> Iterator[tuple[str, str]]:
        for child in self.children(xml):
            name = child.get('name', '').strip(WHITE_SPACE)
            if name:
                scoped = scoped_name(scope, name)
                yield scoped, written_tag(child)
                yield from self._ids(child, scoped)
