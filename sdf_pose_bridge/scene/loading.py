# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Load a file: parse it, replace its includes, read its elements, check and resolve them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
import contextlib
import gc
import os

import numpy as np

from sdf_pose_bridge.errors import LimitError, LoadError, Place, SdfError
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.printed_text import shortened
from sdf_pose_bridge.scene.frame_graph import frame_graph_from_elements
from sdf_pose_bridge.scene.resolution import poses_in_references, scene_from_graph
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.documents import Document, document_from_file
from sdf_pose_bridge.sdformat.element_reader import elements_from_tree
from sdf_pose_bridge.sdformat.elements import NO_ELEMENT
from sdf_pose_bridge.sdformat.include.expansion import IncludeExpansion
from sdf_pose_bridge.sdformat.include.merge import ModelByItself
from sdf_pose_bridge.sdformat.include.uris import resource_finder
from sdf_pose_bridge.sdformat.limits import DEFAULT_LIMITS, Limits, MissingInclude
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.xml_tree import XmlElement


@contextlib.contextmanager
def _without_garbage_collection() -> Iterator[None]:
    """Disable the collector, which would search the elements of a large file again and again."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


@_without_garbage_collection()
@np.errstate(all='ignore')  # numbers that overflow are errors of the file
def load(
    path: str | os.PathLike[str],
    *,
    resource_paths: Iterable[str | os.PathLike[str]] = (),
    on_missing_include: MissingInclude | str = MissingInclude.ERROR,
    limits: Limits = DEFAULT_LIMITS,
    shapes: bool = False,
    plugins: bool = False,
    texts: Mapping[str, bytes | str] | None = None,
) -> Scene:
    """
    Read a file and resolve every pose in it.

    :param path: an SDFormat or URDF file.
    :param resource_paths: directories in which included models are searched first; then come
        the environment variables ``GZ_SIM_RESOURCE_PATH`` and ``SDF_PATH``.
    :param on_missing_include: ``error``, or ``skip`` to leave out includes that are not found.
    :param limits: limits of the size of the load, against hostile files. They do not bound its
        time and memory; to bound these too, call it in a process, as
        :class:`~sdf_pose_bridge.limited_process.LimitedProcess` does.
    :param shapes: whether to also read the shapes of visuals and collisions, masses and moments of
        inertia, and the dynamics of joints.
    :param plugins: whether to also read plugins.
    :param texts: texts to read instead of some files, by their paths as in ``Scene.files``, to try
        a change before it is written.
    :raises SdfError: if the file is not valid; its ``errors`` has all errors.
    """
    on_missing_include = MissingInclude(on_missing_include)
    directories = [os.fspath(each) for each in resource_paths]
    gazebo_errors: list[SdfError] = []
    left_out: set[int] = set()
    while True:
        sources = Sources(limits, texts)
        problems = sources.problems
        try:
            document = document_from_file(os.fspath(path), sources, left_out=left_out)
            for error in gazebo_errors:
                problems.warning(
                    f'{error.message}; so {"this part" if document.gazebo_children else "all"} of '
                    '<gazebo> elements is left out', error.place, error.code, is_for_gazebo=True)
            try:
                return _scene(
                    document, sources, directories, on_missing_include, shapes=shapes,
                    plugins=plugins)
            except LoadError as error:
                if not document.gazebo_children:
                    raise
                # ROS does not read the content of <gazebo> elements, so an error there must not
                # keep a robot from being read. The invalid elements are left out, and if errors
                # remain, all of them.
                found = set() if left_out else document.gazebo_children_at(
                    each.place for each in error.errors)
                left_out |= found or document.gazebo_children.keys()
                gazebo_errors += error.errors
        except LimitError as error:
            # It ends a load at once, after the errors found so far.
            raise LoadError([*problems.errors, error], problems.warnings) from None


def load_text(
    text: str | bytes,
    name: str = '<text>',
    *,
    resource_paths: Iterable[str | os.PathLike[str]] = (),
    on_missing_include: MissingInclude | str = MissingInclude.ERROR,
    limits: Limits = DEFAULT_LIMITS,
    shapes: bool = False,
    plugins: bool = False,
    texts: Mapping[str, bytes | str] | None = None,
) -> Scene:
    """
    Resolve every pose in SDFormat text, as :func:`load` does for a file.

    :param text: the text of a file; bytes in the encoding that they declare.
    :param name: its name in errors; relative includes are searched beside it. The other arguments
        are as in :func:`load`.
    :raises SdfError: as for :func:`load`.
    """
    return load(
        name, resource_paths=resource_paths, on_missing_include=on_missing_include, limits=limits,
        shapes=shapes, plugins=plugins, texts={name: text, **(texts or {})})


def _scene(
    document: Document, sources: Sources, directories: Sequence[str],
    on_missing_include: MissingInclude, *, shapes: bool, plugins: bool,
) -> Scene:
    for directory in directories:
        if not os.path.isdir(directory):  # noqa: PTH112
            sources.problems.warning(
                f'resource_paths names "{shortened(directory)}", which is not a directory',
                Place(document.path))
    IncludeExpansion(
        resource_finder(directories), sources,
        skips_missing=on_missing_include is MissingInclude.SKIP,
        model_by_itself=lambda root: _model_by_itself(root, sources)).expand(document)
    elements = elements_from_tree(document.root, sources, shapes=shapes, plugins=plugins)
    graph = frame_graph_from_elements(elements, sources.problems)
    if graph.names:
        longest = elements.place(graph.names.index(max(graph.names, key=len)))
        characters = sum(map(len, graph.names)) - 64 * len(graph.names)
        sources.usage.check('characters', characters, longest)
    sources.problems.raise_errors()
    return scene_from_graph(document, elements, graph, sources.problems)


def _model_by_itself(root: XmlElement, sources: Sources) -> ModelByItself | None:
    """Check a model file by itself; return facts for a merge, or None if there are errors."""
    part = sources.with_own_problems()
    elements = elements_from_tree(root, part)
    graph = frame_graph_from_elements(elements, part.problems)
    if part.problems.errors:
        sources.problems.add_part(part.problems)
        return None
    model = 1  # element 0 is the implicit root
    link = int(graph.canonical_links[model])
    canonical_link = '' if link == NO_ELEMENT else (
        graph.names[link].removeprefix(f'{graph.names[model]}{SEPARATOR}'))
    return ModelByItself(
        canonical_link, Pose(*poses_in_references(elements, graph)[model].tolist()))
