# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Bring a document of an older version of SDFormat to the newest grammar.

The declared version switches nothing off: what newer versions brought works in every file. It
tells what names and attributes of its time mean now. Steps of libsdformat's conversion that touch
neither poses nor frames are left out.
"""

from __future__ import annotations

from typing import NamedTuple

from sdf_pose_bridge.errors import ConversionError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.names import MODEL_FRAME
from sdf_pose_bridge.sdformat.document import boolean_from_text
from sdf_pose_bridge.sdformat.document import Document
from sdf_pose_bridge.sdformat.document import is_data
from sdf_pose_bridge.sdformat.document import text_of
from sdf_pose_bridge.sdformat.document import XmlElement


class Version(NamedTuple):
    """A version of SDFormat."""

    major: int
    minor: int


OLDEST = Version(1, 2)
NEWEST = Version(1, 12)

_FRAME_ATTRIBUTE_ENDS = Version(1, 7)
_FLAT_NAMES_END = Version(1, 8)
_JOINTS_TURN_WITH_LINKS = Version(1, 5)


def version_of(document: Document) -> Version:
    """
    Read the version that a document declares.

    :param document: a file as it was read.
    :return: its version.
    :raises ConversionError: if SDFormat has no such version, or it is older than 1.2.
    """
    version = version_from_text(document.version)
    if version is None:
        msg = f'version="{document.version}" is none that can be read; 1.2 to 1.12 can'
        raise ConversionError(msg, Place(document.path, document.root.sourceline or 0, '/sdf'))
    return version


def version_from_text(text: str) -> Version | None:
    """
    Read a version.

    :param text: such as ``1.10``.
    :return: the version; None if SDFormat has no such version, or it is older than 1.2.
    """
    major, _, minor = text.partition('.')
    if text.isascii() and major.isdigit() and minor.isdigit() and len(text) < 10:
        version = Version(int(major), int(minor))
        if OLDEST <= version <= NEWEST and text == f'{version.major}.{version.minor}':
            return version
    return None


def upgrade(document: Document) -> None:
    """
    Convert a document in place, by the rules of the version that it declares.

    :param document: a file as it was read; afterwards it has the meaning of version 1.12.
    :raises ConversionError: if its version is unknown, or names in it cannot be converted.
    """
    version = version_of(document)
    if turns_axes_with_model(version):
        _turn_axes_with_model(document.root)
    if has_frame_attributes(version):
        _rename_frame_attributes(document.root)
        _express_axes_in_model(document.root)
    if not may_hold_flat_names(version) or not document.may_hold_separators:
        return
    # Few old files hold such names.
    from sdf_pose_bridge.sdformat.flat_names import unflatten_model
    for model in document.root.iterfind('world/model'):
        unflatten_model(model, document.path)


def turns_axes_with_model(version: Version) -> bool:
    """
    Tell whether axes of joints are given in the model frame if nothing else is said.

    :param version: the version that the file declares.
    :return: true below 1.5.
    """
    return version < _JOINTS_TURN_WITH_LINKS


def has_frame_attributes(version: Version) -> bool:
    """
    Tell whether ``frame`` is what ``relative_to`` is now, and a flag what ``expressed_in`` is.

    :param version: the version that the file declares.
    :return: true below 1.7.
    """
    return version < _FRAME_ATTRIBUTE_ENDS


def may_hold_flat_names(version: Version) -> bool:
    """
    Tell whether names in a file may hold ``::``.

    :param version: the version that the file declares.
    :return: true below 1.8, where old libraries wrote such names.
    """
    return version < _FLAT_NAMES_END


def renames_clashes(version: Version) -> bool:
    """
    Tell whether elements of different kinds may share a name, so that one has to be renamed.

    :param version: the version that the file declares.
    :return: true below 1.7.
    """
    return version < _FRAME_ATTRIBUTE_ENDS


def _turn_axes_with_model(root: XmlElement) -> None:
    models = (model for holder in (root, *root.iterchildren('world'))
              for model in holder.iterchildren('model'))
    for axis in (axis for model in models for joint in model.iterchildren('joint')
                 for axis in joint.iterchildren('axis', 'axis2')):
        xyz = next(axis.iterchildren('xyz'), None)
        if xyz is not None and next(axis.iterchildren('use_parent_model_frame'), None) is None:
            xyz.set('expressed_in', MODEL_FRAME)


def _rename_frame_attributes(root: XmlElement) -> None:
    for pose in root.iter('pose'):
        frame = pose.get('frame')
        if frame is not None and is_data(pose):
            del pose.attrib['frame']
            pose.set('relative_to', frame)


def _express_axes_in_model(root: XmlElement) -> None:
    for flag in list(root.iter('use_parent_model_frame')):
        axis = flag.getparent()
        if axis is None or not is_data(flag):
            continue
        xyz = axis.find('xyz')
        if boolean_from_text(text_of(flag)) and xyz is not None:
            xyz.set('expressed_in', MODEL_FRAME)
        axis.remove(flag)
