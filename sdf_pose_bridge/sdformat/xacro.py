# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Refuse files that xacro has not expanded yet.

They would be read, and would mean something else: macros are not called, and what ``<xacro:if>``
holds is left out. Only declarations, and expressions in plugins and names of topics, change no
frame.
"""

from __future__ import annotations

from collections.abc import Iterator
from collections.abc import Mapping
from pathlib import Path
import re
import shlex

from lxml import etree

from sdf_pose_bridge.errors import ParsingError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.sdformat.xml_tree import text_of
from sdf_pose_bridge.sdformat.xml_tree import written_tag
from sdf_pose_bridge.sdformat.xml_tree import XmlElement

_DECLARATIONS = ('xacro:arg', 'xacro:property')
_EXPRESSION = re.compile(r'\$[({]')


def check_is_expanded(root: XmlElement, path: str, lines: Mapping[XmlElement, int]) -> None:
    """
    Refuse a file in which xacro has something left to do.

    :param root: the outermost element.
    :param path: the file.
    :param lines: the lines of those of its elements whose lines lxml does not know.
    :raises ParsingError: about the first place.
    """
    for xml, found in _unexpanded(root):
        name = Path(path).name
        target = name.removesuffix('.xacro') if name.endswith('.xacro') else f'expanded_{name}'
        command = f': xacro {shlex.quote(name)} -o {shlex.quote(target)}' if '.' in name else ''
        msg = (f'{found} is for xacro, which has to be run before, and what it writes has to be '
               f'read{command}')
        raise ParsingError(msg, Place(path, lines.get(xml, xml.sourceline or 0)))


def _unexpanded(root: XmlElement) -> Iterator[tuple[XmlElement, str]]:
    """Find what is left to do; return each element, and what is in it."""
    waiting = [root]
    while waiting:
        xml = waiting.pop()
        tag = written_tag(xml)
        if tag == 'plugin' or tag in _DECLARATIONS:
            continue
        if tag.startswith('xacro:'):
            yield xml, f'<{tag}>'
        for name, value in xml.items():
            if _EXPRESSION.search(value):
                yield xml, f'{name}="{value}" of <{tag}>'
        text = text_of(xml)
        if _EXPRESSION.search(text) and not tag.endswith('topic'):
            yield xml, f'"{text.strip()}" in <{tag}>'
        waiting += reversed(list(xml.iterchildren(etree.Element)))
