# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Find the elements of an included model by the ``element_id`` of parameters.

An ``element_id`` joins names by ``::``, from the included model inwards. The search works
as in libsdformat (``ParamPassing::getElementById``), with its limits: among siblings it selects
the one whose name is the longest prefix of the id, and continues only inside this one.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from sdf_pose_bridge.names import hint_from_names, scoped_name, SEPARATOR
from sdf_pose_bridge.sdformat.xml_tree import (
    attribute_of,
    child_elements,
    WHITE_SPACE,
    written_tag,
    XmlElement,
)

_MOST_IDS_COMPARED = 2000
_MOST_ELEMENTS_SEARCHED = 10_000
_LONGEST_ID_COMPARED = 200


def element_by_id(top: XmlElement, element_id: str, tag: str = '') -> XmlElement | None:
    """
    Find an element.

    :param element_id: names from the included element, ``top``, inwards.
    :param tag: its tag, as written; empty for any.
    """
    start = longest = 0
    wanted = element_id.encode()  # libsdformat counts bytes
    match: XmlElement | None = top
    while match is not None:
        children, match = child_elements(match), None
        for child in children:
            written = child.get('name')
            if written is None:
                continue
            name = written.strip(WHITE_SPACE).encode()
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


def hint_for_id(top: XmlElement, element_id: str, tag: str) -> str:
    """
    Return the end of a message about an id that was not found.

    :return: a likely reason, or the nearest id; else an empty string.
    """
    if len(element_id) > _LONGEST_ID_COMPARED:
        return ''
    searched = islice(_ids(top, ''), _MOST_ELEMENTS_SEARCHED)
    ids = list(islice((found for found in searched if found[0]), _MOST_IDS_COMPARED))
    tags = [found_tag for found_id, found_tag in ids if found_id == element_id]
    if tag in tags and len(element_id.split(SEPARATOR)[0].encode()) == 1:
        return '; libsdformat does not find names of one letter at the top of a model'
    if tag in tags:
        return f'; libsdformat finds only the <{tags[0]}> of that name, which comes before it'
    if tags:
        return f'; that is a <{tags[0]}>'
    wanted = (found_id for found_id, found_tag in ids if tag in ('', found_tag))
    return hint_from_names(element_id, wanted)


def _ids(xml: XmlElement, scope: str) -> Iterator[tuple[str, str]]:
    """Iterate over the ids in an element, and their tags; empty ones for those without."""
    for child in child_elements(xml):
        name = attribute_of(child, 'name')
        scoped = scoped_name(scope, name)
        if name and len(scoped) <= 2 * _LONGEST_ID_COMPARED:
            yield scoped, written_tag(child)
            yield from _ids(child, scoped)
        else:
            yield '', ''
