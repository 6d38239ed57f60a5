# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""From a file to a Scene: one stage after the other, with all errors of the file at once."""

from __future__ import annotations

from collections.abc import Iterable
from collections.abc import Iterator
import contextlib
import enum
import gc
import os

from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.scene.frame_graph import frame_graph_from_elements
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.scene.scene_assembly import scene_from_graph
from sdf_pose_bridge.sdformat.checks import check_values
from sdf_pose_bridge.sdformat.document import Document
from sdf_pose_bridge.sdformat.document_reading import document_from_file
from sdf_pose_bridge.sdformat.document_reading import document_from_text
from sdf_pose_bridge.sdformat.include.inclusions import document_set
from sdf_pose_bridge.sdformat.include.inclusions import DocumentSet
from sdf_pose_bridge.sdformat.include.resources import resource_finder
from sdf_pose_bridge.sdformat.reader import elements_from_documents


class MissingInclude(enum.Enum):
    """What to do about an include that cannot be found."""

    ERROR = 'error'
    """The file is not valid."""
    SKIP = 'skip'
    """It is left out, with a warning."""


def load(
    path: str | os.PathLike[str],
    *,
    resource_paths: Iterable[str | os.PathLike[str]] = (),
    on_missing_include: MissingInclude | str = MissingInclude.ERROR,
) -> Scene:
    """
    Read a file and resolve every pose in it.

    :param path: path of an SDFormat file.
    :param resource_paths: directories in which included models are looked for first; then come
        those of the environment variables ``GZ_SIM_RESOURCE_PATH`` and ``SDF_PATH``.
    :param on_missing_include: ``error``, or ``skip`` to leave out what cannot be found.
    :return: the scene.
    :raises SdfError: if the file is not valid; ``errors`` on it has all that was found.
    """
    with _collection_paused():
        return _resolved_scene(
            document_from_file(path), resource_paths, MissingInclude(on_missing_include))


def load_text(
    text: str | bytes,
    name: str = '<text>',
    *,
    resource_paths: Iterable[str | os.PathLike[str]] = (),
    on_missing_include: MissingInclude | str = MissingInclude.ERROR,
) -> Scene:
    """
    Resolve every pose in SDFormat text, as :func:`load` does for a file.

    :param text: the content of an SDFormat file.
    :param name: what to call it in errors; relative includes are looked for beside it.
    :param resource_paths: as for :func:`load`.
    :param on_missing_include: as for :func:`load`.
    :return: the scene.
    :raises SdfError: as for :func:`load`.
    """
    with _collection_paused():
        return _resolved_scene(
            document_from_text(text, name), resource_paths, MissingInclude(on_missing_include))


@contextlib.contextmanager
def _collection_paused() -> Iterator[None]:
    """
    Keep the garbage collector from looking through the elements of a large file again and again.

    A load makes no cycles of objects that matter.
    """
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


def _resolved_scene(
    document: Document,
    resource_paths: Iterable[str | os.PathLike[str]],
    on_missing_include: MissingInclude,
) -> Scene:
    documents = document_set(document, resource_finder(resource_paths, os.environ))
    problems = Problems(documents.files)
    for each in documents.all_documents():
        check_values(each, problems)
    skips_missing = on_missing_include is MissingInclude.SKIP
    broken = _broken_documents(documents, problems, skips_missing=skips_missing)
    table = elements_from_documents(
        documents, problems, broken=broken, skips_missing=skips_missing)
    graph = frame_graph_from_elements(table, problems)
    problems.raise_any()
    return scene_from_graph(documents, table, graph, problems.warnings)


def _broken_documents(
    documents: DocumentSet, problems: Problems, *, skips_missing: bool,
) -> frozenset[str]:
    """Check what is merged on its own, where it cannot use names of what it is merged into."""
    broken: set[str] = set()
    for document in documents.merged():
        own_problems = Problems(documents.files)
        table = elements_from_documents(
            documents._replace(document=document), own_problems,
            broken=frozenset(broken), skips_missing=skips_missing)
        frame_graph_from_elements(table, own_problems)
        if own_problems.errors:
            broken.add(document.path)
            problems.extend(own_problems)
    return frozenset(broken)
