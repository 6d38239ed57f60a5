# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Bring a document of an older version of SDFormat to the newest grammar."""

from __future__ import annotations

from sdf_pose_bridge.document import Document
from sdf_pose_bridge.errors import ConversionError
from sdf_pose_bridge.errors import Place

OLDEST = (1, 2)
NEWEST = (1, 12)
_OLDEST_READ = (1, 7)


def document_in_newest_version(document: Document) -> Document:
    """
    Convert a document by the rules of the version that it declares.

    :param document: a file as it was read.
    :return: the same content in the grammar of version 1.12.
    :raises ConversionError: if the version is unknown, or one that cannot be converted.
    """
    place = Place(document.path, document.root.sourceline or 0, '/sdf')
    version = version_from_text(document.version)
    if version is None:
        msg = f'version="{document.version}" is unknown; SDFormat 1.2 to 1.12 can be read'
        raise ConversionError(msg, place)
    if version < _OLDEST_READ:
        msg = (f'version="{document.version}" is older than 1.7 and cannot be read yet; '
               '"gz sdf -p" prints the file in a newer version')
        raise ConversionError(msg, place)
    return document


def version_from_text(text: str) -> tuple[int, int] | None:
    """
    Read the value of a ``version`` attribute.

    :param text: such as ``1.10``.
    :return: such as ``(1, 10)``, or None if SDFormat has no such version.
    """
    major, _, minor = text.partition('.')
    if not (major.isascii() and major.isdigit() and minor.isascii() and minor.isdigit()):
        return None
    version = (int(major), int(minor))
    is_spelled_so = text == f'{version[0]}.{version[1]}'
    return version if is_spelled_so and OLDEST <= version <= NEWEST else None
