# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The formats of files, of which all become SDFormat."""

from __future__ import annotations

import enum

from sdf_pose_bridge.errors import ParsingError, Place
from sdf_pose_bridge.sdformat.xml_tree import written_tag, XmlElement


class SourceFormat(enum.Enum):
    """
    The format of a file: its name, and the tag of the outermost element.

    Of several outermost elements, the one of the first format is read.
    """

    SDFORMAT = 'SDFormat', 'sdf'
    URDF = 'URDF', 'robot'

    def __init__(self, title: str, tag: str) -> None:
        self.title, self.tag = title, tag


def source_format_of(root: XmlElement, place: Place) -> SourceFormat:
    """
    Return the format of a file by its outermost element.

    :raises ParsingError: if no format has such an element.
    """
    for each in SourceFormat:
        if root.tag == each.tag:
            return each
    tags = ' or '.join(f'<{each.tag}>' for each in SourceFormat)
    msg = f'the outermost element is <{written_tag(root)}>, it must be {tags}'
    raise ParsingError(msg, place)
