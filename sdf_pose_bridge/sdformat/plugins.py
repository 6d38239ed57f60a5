# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Read the plugins of Gazebo in elements. Source of their names: gz-sim 8 to 10."""

from __future__ import annotations

import re
from typing import NamedTuple

from sdf_pose_bridge.sdformat.xml_tree import attribute_of, child_elements, value_of, XmlElement

_CLASS = re.compile(r'(?:gz::sim|ignition::gazebo)::systems::(\w+)')
_LIBRARY = re.compile(r'(?:lib)?(?:gz-sim|ignition-gazebo)\d*-(.+)-system(?:\.so)?')


class Plugin(NamedTuple):
    """A ``<plugin>``; the content is not SDFormat, and has a meaning for its class only."""

    filename: str
    """The library, as written."""
    name: str
    """The name of its class, as written; empty for the first class of the library."""
    parameters: tuple[tuple[str, str], ...]
    """The tag and the value of each child element, in the order of the file."""

    @property
    def system(self) -> str:
        """The class without its name space, such as ``DiffDrive``; empty if it is not Gazebo's."""
        if found := _CLASS.fullmatch(self.name):
            return found[1]
        found = _LIBRARY.fullmatch(self.filename)
        return ''.join(map(str.capitalize, found[1].split('-'))) if found else ''


def plugins_of(xml: XmlElement) -> tuple[Plugin, ...]:
    """Return the plugins of an element."""
    return tuple(
        Plugin(
            attribute_of(plugin, 'filename'), attribute_of(plugin, 'name'),
            tuple((str(each.tag), value_of(each)) for each in child_elements(plugin)))
        for plugin in child_elements(xml, 'plugin'))
