# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Find elements of an included model by ``element_id``, and children of elements by name.

An ``element_id`` joins names by ``::``, from the included model inwards. The search works
as in libsdformat (``ParamPassing::getElementById``), with its limits: among siblings it selects
the one whose name is the longest prefix of the id, and continues only inside this one.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Hashable, Iterator
from heapq import heappop, heappush
from itertools import count, islice

from sdf_pose_bridge.names import scoped_name, SEPARATOR
from sdf_pose_bridge.nearest_names import hint_from_names
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.sdformat.xml_tree import (
    attribute_of,
    child_elements,
    written_tag,
    XmlElement,
)

_MOST_ELEMENTS_SEARCHED = 10_000
_LONGEST_ID = 400


class ElementIds:
    """
    Finds elements in an included element while it is changed.

    Elements may be removed. New ones, and those with a new name, have to be added.
    """

    def __init__(self, top: XmlElement) -> None:
        self._top = top
        self._numbers = count()
        self._positions: dict[XmlElement, int] = {}
        self._children = defaultdict[Hashable, list[tuple[int, int, XmlElement]]](list)
        """Heaps of children by parent and tag, with a name or without, and by parent and name, as
        bytes. Some have been removed or renamed since."""
        self._lengths: dict[XmlElement | None, set[int]] = {}
        """The lengths in bytes of the names in each element that was searched."""

    def add(self, xml: XmlElement, in_place_of: XmlElement | None = None) -> None:
        """Add an element, by default as the last child of its parent."""
        if xml.getparent() in self._lengths:
            number = next(self._numbers)
            self._positions[xml] = (
                number if in_place_of is None else self._positions[in_place_of])
            for key in self._keys(xml):
                heappush(self._children[key], (self._positions[xml], number, xml))

    def child(self, parent: XmlElement, tag: str, name: str | None = None) -> XmlElement | None:
        """Return the first child with a tag, and with a name if one is given, as written."""
        self._lengths_in(parent)
        found = self._first(parent, (tag, name))
        return None if found is None else found[1]

    def element(self, element_id: str, tag: str = '') -> XmlElement | None:
        """Find an element by its id and its tag as written; any tag if that is empty."""
        start = longest = 0
        wanted = element_id.encode()  # libsdformat counts bytes
        match: XmlElement | None = self._top
        while match is not None:
            children, match = self._named_in(match, wanted, start), None
            for name, child in children:
                if not tag and name == wanted:
                    return child
                last = start + len(name) - 1
                if last <= longest or not wanted.startswith(name, start):
                    continue
                if wanted[start:] == name and tag in ('', written_tag(child)):
                    return child
                match, longest = child, last
            start = longest
            if wanted.startswith(SEPARATOR.encode(), start + 1):
                start += 1 + len(SEPARATOR)
        return None

    def _keys(self, xml: XmlElement) -> list[Hashable]:
        parent, tag, name = xml.getparent(), written_tag(xml), xml.get('name')
        if name is None:
            return [(parent, (tag, None))]
        in_bytes = attribute_of(xml, 'name').encode()
        self._lengths[parent].add(len(in_bytes))
        return [(parent, (tag, None)), (parent, (tag, name)), (parent, in_bytes)]

    def _first(self, parent: XmlElement, key: Hashable) -> tuple[int, XmlElement] | None:
        """Return the first child with a key, and its position."""
        heap = self._children.get((parent, key), [])
        while heap:
            position, _, child = heap[0]
            if child.getparent() is parent and (parent, key) in self._keys(child):
                return position, child
            heappop(heap)
        return None

    def _lengths_in(self, parent: XmlElement) -> set[int]:
        if parent not in self._lengths:
            self._lengths[parent] = set()
            for child in child_elements(parent):
                self.add(child)
        return self._lengths[parent]

    def _named_in(
        self, parent: XmlElement, wanted: bytes, start: int,
    ) -> list[tuple[bytes, XmlElement]]:
        """Return the first child of each name that is an id, or that the id has at ``start``."""
        names = {wanted, *(wanted[start:start + n] for n in self._lengths_in(parent))}
        found = sorted(
            (*child, name) for name in names if (child := self._first(parent, name)) is not None)
        return [(name, child) for _, child, name in found]


def hint_for_id(top: XmlElement, element_id: str, problems: Problems, tag: str = '') -> str:
    """
    Return the end of a message about an id that was not found: a likely reason, or the nearest id.

    :param problems: the problems of the load, which limit the number of hints.
    """
    if not problems.allows_hint():
        return ''
    ids = [*filter(None, islice(_ids(top, ''), _MOST_ELEMENTS_SEARCHED))]
    tags = [found_tag for found_id, found_tag in ids if found_id == element_id]
    if tag in tags and len(element_id.split(SEPARATOR)[0].encode()) == 1:
        return '; libsdformat does not find names of one letter at the top of a model'
    if tag in tags:
        return f'; libsdformat finds only the <{tags[0]}> of that name, which comes before it'
    if tags:
        return f'; that is a <{tags[0]}>'
    wanted = (found_id for found_id, found_tag in ids if tag in ('', found_tag))
    return hint_from_names(element_id, wanted)


def _ids(xml: XmlElement, scope: str) -> Iterator[tuple[str, str] | None]:
    """Iterate over the elements in an element: id and tag, or None if it has no id."""
    for child in child_elements(xml):
        name = attribute_of(child, 'name')
        scoped = scoped_name(scope, name)
        if name and len(scoped) <= _LONGEST_ID:
            yield scoped, written_tag(child)
            yield from _ids(child, scoped)
        else:
            yield None
