# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""From a file to a Scene: one stage after the other, with all errors of the file at once."""

from __future__ import annotations

from collections.abc import Iterable
import os

from sdf_pose_bridge.document import Document
from sdf_pose_bridge.document import document_from_file
from sdf_pose_bridge.document import document_from_text
from sdf_pose_bridge.element_reader import elements_from_document
from sdf_pose_bridge.frame_graph import frame_graph_from_elements
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.scene import Scene
from sdf_pose_bridge.scene_assembly import scene_from_graph
from sdf_pose_bridge.versions import document_in_newest_version


def load(
    path: str | os.PathLike[str], *, resource_paths: Iterable[str | os.PathLike[str]] = (),
) -> Scene:
    """
    Read a file and resolve every pose in it.

    :param path: path of an SDFormat file.
    :param resource_paths: directories in which included models are looked for first.
    :return: the scene.
    :raises SdfError: if the file is not valid; ``errors`` on it has all that was found.
    """
    del resource_paths  # nothing that is included can be read yet
    return _scene_from_document(document_from_file(path))


def load_text(text: str | bytes, name: str = '<text>') -> Scene:
    """
    Resolve every pose in SDFormat text, as :func:`load` does for a file.

    :param text: the content of an SDFormat file.
    :param name: what to call it in errors.
    :return: the scene.
    :raises SdfError: as for :func:`load`.
    """
    return _scene_from_document(
        document_from_text(text.encode() if isinstance(text, str) else text, name))


def _scene_from_document(document: Document) -> Scene:
    problems = Problems()
    table = elements_from_document(document_in_newest_version(document), problems)
    graph = frame_graph_from_elements(table, problems)
    problems.raise_any()
    return scene_from_graph(document.path, table, graph, problems.warnings)
