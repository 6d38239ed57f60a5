# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Find the SDFormat file of a model directory: its ``model.config`` names one for each version."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

from sdf_pose_bridge.errors import FileReadError
from sdf_pose_bridge.errors import ParsingError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.sdformat.document import text_of
from sdf_pose_bridge.sdformat.document import WHITE_SPACE
from sdf_pose_bridge.sdformat.xml_file import root_from_file

_NAMES = ('model.config', 'manifest.xml')
_NEWEST = (1, 12)


class ModelFile(NamedTuple):
    """What a model directory offers."""

    path: str
    """The SDFormat file to read."""
    manifest: str
    """The file that names it."""
    warnings: tuple[SdfWarning, ...]


def model_file_from_directory(directory: str) -> ModelFile:
    """
    Choose the file of the newest version that can be read.

    :param directory: a model directory.
    :return: the file, which need not exist.
    :raises FileReadError: if there is no manifest, or it is not XML.
    :raises ParsingError: if the manifest names no file.
    """
    # Unlike Path's, this raises no error for what may not be looked at.
    manifests = [
        path for path in (Path(directory, name) for name in _NAMES)
        if os.path.exists(path)]  # noqa: PTH110
    if not manifests:
        msg = 'the directory has no model.config, which would name the file to read'
        raise FileReadError(msg, Place(directory))
    manifest = str(manifests[0])
    warnings = []
    if manifests[0].name != _NAMES[0]:
        msg = f'{_NAMES[1]} is deprecated; it should be called {_NAMES[0]}'
        warnings.append(SdfWarning('WARNING', msg, Place(manifest)))
    root = root_from_file(manifest)
    best: tuple[int, ...] = (0, 0)
    chosen = None
    for entry in root.iterchildren('sdf'):
        version = _version_from_text(entry.get('version', ''))
        if version > _NEWEST:
            msg = f'version {entry.get("version")} of the model is newer than 1.12 and left out'
            place = Place(manifest, entry.sourceline or 0, '/model/sdf')
            warnings.append(SdfWarning('WARNING', msg, place))
        elif chosen is None or version > best:
            best, chosen = version, entry
    if chosen is None:
        chosen = next(root.iterchildren('sdf'), None)
    name = '' if chosen is None else text_of(chosen).strip(WHITE_SPACE)
    if root.tag != 'model' or chosen is None or not name:
        msg = 'the manifest names no file: it has no <sdf> in a <model>'
        raise ParsingError(msg, Place(manifest, root.sourceline or 0))
    if chosen.get('version') is None:
        msg = '<sdf> says for no version that it is'
        place = Place(manifest, chosen.sourceline or 0, '/model/sdf')
        warnings.append(SdfWarning('WARNING', msg, place))
    return ModelFile(str(Path(directory, name)), manifest, tuple(warnings))


def _version_from_text(text: str) -> tuple[int, ...]:
    parts = text.strip(WHITE_SPACE).split('.')
    if all(part.isascii() and part.isdigit() and len(part) < 6 for part in parts):
        return tuple(int(part) for part in parts)
    return (0, 0)
