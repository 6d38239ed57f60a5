# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read large files, and leave what is regular out of their trees.

Most of a large file is regular, and is found in its text. Only the rest has to be looked at
element by element.
"""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Sequence
import re

from sdf_pose_bridge.document import Document
from sdf_pose_bridge.markup_index import index_from_remainder
from sdf_pose_bridge.remainder import Remainder
from sdf_pose_bridge.remainder import remainders_from_tags
from sdf_pose_bridge.tag_search import tags_from_texts
from sdf_pose_bridge.versions import has_frame_attributes
from sdf_pose_bridge.versions import turns_axes_with_model
from sdf_pose_bridge.versions import Version
from sdf_pose_bridge.versions import version_from_text
from sdf_pose_bridge.well_formedness import WellFormednessCheck
from sdf_pose_bridge.xml_reading import root_from_text
from sdf_pose_bridge.xml_reading import UTF_8_NAMES

_HEAD = re.compile(
    rb'(?:<\?xml([^>]*)\?>)?\s*(?:<!--(?:(?!--).)*-->\s*)*'
    rb'<sdf\s(?:[^>]*\s)?version\s*=\s*["\']([0-9.]*)["\']', re.DOTALL)
_ENCODING = rb'encoding\s*=\s*["\']([^"\']*)'

# Deeper and longer ones are for the parser to judge.
_DEEPEST = 250
_LONGEST_TEXT = 9_000_000

_PART = 1 << 23
"""So many bytes of a file are looked at at a time."""


def documents_without_regular_part(contents: Mapping[str, bytes]) -> dict[str, Document]:
    """
    Read files, and leave what is regular out of their trees.

    :param contents: what they hold, by their paths; without names that hold ``::``.
    :return: the documents, by their paths; without those that need their whole trees.
    """
    groups: dict[tuple[bool, bool], dict[str, bytes]] = {}
    for path, content in contents.items():
        version = _early_version(content)
        if version is not None:
            rules = turns_axes_with_model(version), has_frame_attributes(version)
            groups.setdefault(rules, {})[path] = content
    found: dict[str, Document] = {}
    for group in groups.values():
        found.update(_documents_of_one_grammar(group))
    return found


def may_be_joined(content: bytes) -> bool:
    """
    Tell whether a file can be read together with others.

    :param content: what it holds.
    :return: false if it would keep all others from being read so.
    """
    declaration = content.find(b'?>') + 2 if content.startswith(b'<?xml') else 0
    return content.find(b'?', declaration) < 0 and b'<include' not in content and (
        content.find(b'!') < 0 or re.search(rb'<!(?!--)', content) is None)


def _documents_of_one_grammar(contents: Mapping[str, bytes]) -> dict[str, Document]:
    texts = list(contents.values())
    check = WellFormednessCheck(texts)
    try:
        remainders = _remainders(texts)
    except Exception:
        # What happens with a text that is not well-formed does not matter.
        if check.are_well_formed():
            raise
        return {}
    if remainders is None or not check.are_well_formed():
        return {}
    found = {}
    for (path, content), remainder in zip(contents.items(), remainders, strict=True):
        root, warnings = root_from_text(remainder.text, path)
        declared = root.get('version', '')
        if version_from_text(declared) == _early_version(content):
            found[path] = Document(
                path, root, declared, warnings, is_large=True, text=content,
                may_hold_separators=False, elements=index_from_remainder(root, remainder))
    return found


def _remainders(texts: Sequence[bytes]) -> list[Remainder] | None:
    """Take out what is regular; None if there is something that needs a whole tree."""
    tags, version = tags_from_texts(texts), _early_version(texts[0])
    if tags is None or version is None or tags.deepest > _DEEPEST or (
            tags.longest_text > _LONGEST_TEXT):
        return None
    return remainders_from_tags(tags, texts, version, _PART)


def _early_version(text: bytes) -> Version | None:
    """Look for the version of a text, before it is parsed; None if it is not surely in UTF-8."""
    head = _HEAD.match(text)
    if head is None:
        return None
    encoding = re.search(_ENCODING, head.group(1) or b'')
    if encoding and encoding.group(1).decode('latin-1') not in UTF_8_NAMES:
        return None
    return version_from_text(head.group(2).decode('ascii'))
