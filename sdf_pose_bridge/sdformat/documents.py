# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Read SDFormat files into trees of the newest version."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from sdf_pose_bridge.errors import AttributeInvalidError, Place
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.sdformat.gazebo_releases import warn_of_releases
from sdf_pose_bridge.sdformat.source_formats import source_format_of, SourceFormat
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.templates import check_is_expanded
from sdf_pose_bridge.sdformat.urdf.conversion import sdf_from_urdf
from sdf_pose_bridge.sdformat.versions import convert, version_of
from sdf_pose_bridge.sdformat.xml_file import xml_from_file
from sdf_pose_bridge.sdformat.xml_tree import XmlElement


class Document(NamedTuple):
    """One file as a tree."""

    path: str
    source_format: SourceFormat
    root: XmlElement
    """The ``sdf`` element."""
    urdf_root: str = ''
    """The name of the root link, for URDF; else empty."""
    gazebo_children: Mapping[int, Place] = MappingProxyType({})
    """For URDF the places of the children of ``<gazebo>`` elements, by their indices in the file,
    without those that are left out."""

    def gazebo_children_at(self, places: Iterable[Place]) -> set[int]:
        """Return the children of ``<gazebo>`` elements that contain some places."""
        return {max(indices) for place in places if (indices := [
            index for index, child in self.gazebo_children.items()
            if f'{place.element}/'.startswith(f'{child.element}/')
            and place.file == child.file and child.line <= place.line])}


def document_from_file(
    path: str, sources: Sources, *, is_included: bool = False,
    left_out: Iterable[int] = (),
) -> Document:
    """
    Read a file, or the text of its name in ``sources.texts``.

    :param is_included: whether to convert URDF as libsdformat does.
    :param left_out: the children of ``<gazebo>`` elements of a URDF file that are left out, by
        their indices in the file.
    :return: the file, in the newest version.
    :raises SdfError: if it cannot be read or converted; a LimitError if it is too large.
    """
    sources.add_path(path)
    file = xml_from_file(path, sources.usage, sources.texts.get(path))
    root = file.root
    sources.add_tree(path, root, file.lines)
    sources.problems.extend(file.warnings)
    check_is_expanded(root, path, file.text, sources)
    warn_of_releases(root, sources)
    source_format = source_format_of(root, sources.place(root))
    gazebo_children: dict[int, Any] = {}
    urdf_root = ''
    match source_format:
        case SourceFormat.SDFORMAT:
            pass
        case SourceFormat.URDF:
            gazebo_children = dict(enumerate(root.xpath('gazebo/*')))
            for child in map(gazebo_children.pop, left_out):
                child.getparent().remove(child)
            root, urdf_root = sdf_from_urdf(root, sources, is_included=is_included)
            sources.add_tree(path, root, file.lines)
            # All links and joints are converted; further problems come from <gazebo> elements.
            sources.problems.are_for_gazebo |= not is_included
    version = version_of(root, sources.place(root))
    sources.versions[path] = version
    # A colon may be written as a character reference.
    # Python finds one byte much faster than two.
    sources.may_hold_scoped_names |= b'&' in file.text or (
        b':' in file.text and SEPARATOR.encode() in file.text)
    convert(root, version, sources)
    # libsdformat refuses it in a file's top model (checkXmlFromRoot). Blanks count here.
    for pose in root.xpath('model[1]/pose[1][@relative_to!=""]'):
        msg = (f'relative_to="{pose.get("relative_to")}": a model at the top of a file is placed '
               'in the implicit root, which has no frames')
        sources.error(AttributeInvalidError, pose, msg)
        del pose.attrib['relative_to']
    return Document(path, source_format, root, urdf_root, {
        index: sources.place(child) for index, child in gazebo_children.items()})
