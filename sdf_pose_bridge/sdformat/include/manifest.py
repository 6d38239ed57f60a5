# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Find the SDFormat file of a model directory: its ``model.config`` names one for each version.

Source: ``getModelFilePath`` and ``getBestSupportedModelVersion`` of libsdformat.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

from sdf_pose_bridge.errors import FileReadError
from sdf_pose_bridge.errors import ParsingError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.names import shortened
from sdf_pose_bridge.sdformat.limits import Usage
from sdf_pose_bridge.sdformat.versions import NEWEST
from sdf_pose_bridge.sdformat.xml_file import bytes_from_file
from sdf_pose_bridge.sdformat.xml_file import xml_from_bytes
from sdf_pose_bridge.sdformat.xml_tree import child_elements
from sdf_pose_bridge.sdformat.xml_tree import first_child
from sdf_pose_bridge.sdformat.xml_tree import text_of
from sdf_pose_bridge.sdformat.xml_tree import WHITE_SPACE

_NAME = 'model.config'
_DEPRECATED_NAME = 'manifest.xml'


class ModelFile(NamedTuple):
    """The file that a model directory offers."""

    path: str
    """The SDFormat file."""
    manifest: str
    """The file that names it."""
    warnings: tuple[SdfWarning, ...]


def model_file_from_directory(directory: str, usage: Usage) -> ModelFile:
    """
    Choose the file of the newest version that is supported.

    :param directory: a model directory.
    :param usage: counts the bytes and elements of its manifest.
    :return: the file, which need not exist.
    :raises FileReadError: if there is no manifest, or it is not XML.
    :raises ParsingError: if the manifest does not name a file.
    :raises LimitError: if the manifest is too large.
    """
    # Unlike Path.exists, this returns False for a directory that may not be read.
    manifests = [
        name for name in (_NAME, _DEPRECATED_NAME)
        if os.path.exists(Path(directory, name))]  # noqa: PTH110
    if not manifests:
        msg = f'the directory has no {_NAME}, which would name the file to read'
        raise FileReadError(msg, Place(directory))
    manifest = str(Path(directory, manifests[0]))
    warnings = []
    if manifests[0] == _DEPRECATED_NAME:
        msg = f'{_DEPRECATED_NAME} is deprecated; it should be called {_NAME}'
        warnings.append(SdfWarning('WARNING', msg, Place(manifest)))
    text = bytes_from_file(manifest, usage)
    usage.add_elements_of(text, Place(manifest))
    root, xml_warnings, _ = xml_from_bytes(text, manifest)
    warnings += xml_warnings
    best: tuple[int, ...] = (0, 0)
    chosen = None
    for entry in child_elements(root, 'sdf'):
        version = _version_from_text(entry.get('version', ''))
        if version > NEWEST:
            written = shortened(entry.get('version', ''))
            msg = f'version {written} of the model is newer than {NEWEST} and skipped'
            place = Place(manifest, entry.sourceline or 0, '/model/sdf')
            warnings.append(SdfWarning('WARNING', msg, place))
        elif chosen is None or version > best:
            best, chosen = version, entry
    if chosen is None:
        chosen = first_child(root, 'sdf')
    name = '' if chosen is None else text_of(chosen).strip(WHITE_SPACE)
    if root.tag != 'model' or chosen is None or not name:
        msg = 'the manifest names no file: it has no <sdf> in a <model>'
        raise ParsingError(msg, Place(manifest, root.sourceline or 0))
    if chosen.get('version') is None:
        msg = '<sdf> does not say which version the file has'
        place = Place(manifest, chosen.sourceline or 0, '/model/sdf')
        warnings.append(SdfWarning('WARNING', msg, place))
    return ModelFile(str(Path(directory, name)), manifest, tuple(warnings))


def _version_from_text(text: str) -> tuple[int, ...]:
    parts = text.strip(WHITE_SPACE).split('.')
    if all(part.isascii() and part.isdigit() and len(part) < 6 for part in parts):
        return tuple(int(part) for part in parts)
    return (0, 0)
