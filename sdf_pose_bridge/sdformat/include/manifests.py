# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Choose the file of a model by the manifest in its directory.

``model.config`` names a file for each version: ``getModelFilePath`` and
``getBestSupportedModelVersion`` of libsdformat.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

from sdf_pose_bridge.errors import FileReadError, ParsingError, Place, SdfWarning
from sdf_pose_bridge.printed_text import shortened
from sdf_pose_bridge.sdformat.limits import Usage
from sdf_pose_bridge.sdformat.versions import NEWEST, version_numbers
from sdf_pose_bridge.sdformat.xml_file import xml_from_file
from sdf_pose_bridge.sdformat.xml_tree import attribute_of, child_elements, first_child, value_of

MANIFEST = 'model.config'
_DEPRECATED_NAME = 'manifest.xml'


class ModelFile(NamedTuple):
    """The model file that the manifest of a directory names."""

    path: str
    manifest: str
    warnings: tuple[SdfWarning, ...]


def model_file_from_directory(directory: str, usage: Usage) -> ModelFile:
    """
    Choose the file of the newest version that is supported.

    :return: the file, which need not exist.
    :raises SdfError: if there is no manifest that names a file.
    """
    # Unlike Path.exists, this returns False for a directory without permission.
    manifests = [
        name for name in (MANIFEST, _DEPRECATED_NAME)
        if os.path.exists(Path(directory, name))]  # noqa: PTH110
    if not manifests:
        msg = f'the directory has no {MANIFEST}, which would name the file to read'
        raise FileReadError(msg, Place(directory))
    manifest = str(Path(directory, manifests[0]))
    warnings = []
    if manifests[0] == _DEPRECATED_NAME:
        msg = f'{_DEPRECATED_NAME} is deprecated; it should be called {MANIFEST}'
        warnings.append(SdfWarning('WARNING', msg, Place(manifest)))
    file = xml_from_file(manifest, usage)
    root = file.root
    warnings += file.warnings
    versions = {}
    for entry in child_elements(root, 'sdf'):
        version = version_numbers(attribute_of(entry, 'version'))
        if version > NEWEST:
            written = shortened(entry.get('version', ''))
            msg = f'version {written} of the model is newer than {NEWEST} and skipped'
            place = Place(manifest, entry.sourceline or 0, '/model/sdf')
            warnings.append(SdfWarning('WARNING', msg, place))
        else:
            versions[entry] = version
    chosen = max(versions, key=versions.__getitem__, default=first_child(root, 'sdf'))
    name = '' if chosen is None else value_of(chosen)
    if root.tag != 'model' or chosen is None or not name:
        msg = 'the manifest names no file: it has no <sdf> in a <model>'
        raise ParsingError(msg, Place(manifest, root.sourceline or 0))
    return ModelFile(str(Path(directory, name)), manifest, tuple(warnings))
