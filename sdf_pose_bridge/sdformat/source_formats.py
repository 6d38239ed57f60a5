# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The formats of files, of which all become SDFormat."""

from __future__ import annotations

import enum

from sdf_pose_bridge.errors import ParsingError, Place
from sdf_pose_bridge.sdformat.xml_tree import written_tag, XmlElement


class SourceFormat(enum.Enum):
    """
    The format of a file: its name, the tag of the outermost element, and the end of file names.

    Of several outermost elements, the one of the first format is read.
    """

    SDFORMAT = 'SDFormat', 'sdf', '.sdf'
    URDF = 'URDF', 'robot', '.urdf'

    def __init__(self, title: str, tag: str, suffix: str) -> None:
        self.title, self.tag, self.suffix = title, tag, suffix


def source_format_of(root: XmlElement, place: Place) -> SourceFormat:
    """Return the format of a file by its outermost element; raise ParsingError for others."""
    for each in SourceFormat:
        if root.tag == each.tag:
            return each
    tags = ' or '.join(f'<{each.tag}>' for each in SourceFormat)
    msg = f'the outermost element is <{written_tag(root)}>, it must be {tags}'
    raise ParsingError(msg, place)
