# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Load the files of a command, and find frames in them by their names in SDF and TF."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
import contextlib
from functools import partial
import os
import sys
import threading
from typing import Any

from sdf_pose_bridge.cli.printing import print_problems
from sdf_pose_bridge.errors import SdfError, SdfWarning
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.printed_text import printable
from sdf_pose_bridge.scene.loading import load
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.limits import FOLLOWED, Usage
from sdf_pose_bridge.sdformat.xml_file import bytes_from_file
from sdf_pose_bridge.tf.lookup import lookup_from_scene
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

STANDARD_INPUT = '-'
"""The argument for the standard input."""


def scene_from_file(
    path: str, options: argparse.Namespace, terminal: int = 2, **parts: bool,
) -> Scene:
    """
    Load a file, or a pipe such as the shell's ``<(command)``.

    :param path: path of the file; ``-`` for the standard input, beside which includes are searched
        in the working directory.
    :param terminal: as for :func:`told_on_terminal`.
    :param parts: ``shapes`` and ``plugins`` as for :func:`~sdf_pose_bridge.load`.
    :raises SdfError: if the file is not valid.
    """
    is_input = path == STANDARD_INPUT
    with told_on_terminal(path, terminal):
        text = bytes_from_file('/dev/stdin' if is_input else path, Usage(), allows_pipe=True)
        path = '<stdin>' if is_input else path
        return loader(path, options, **parts)(texts={path: text})


def loader(path: str, options: argparse.Namespace, **parts: Any) -> partial[Scene]:
    """Return a function that loads a file as :func:`scene_from_file`."""
    return partial(load, path, resource_paths=options.resource_paths,
                   on_missing_include='skip' if options.skip_missing else 'error', **parts)


@contextlib.contextmanager
def told_on_terminal(path: str, terminal: int = 2) -> Iterator[None]:
    """Tell on a terminal, by its descriptor, how much was read, after the first second."""
    if not os.isatty(terminal):
        yield
        return
    followed, has_ended = list[Usage](), threading.Event()

    def tell() -> None:
        told = ''
        while not has_ended.wait(0.2 if told else 1.0):
            usage = [Usage(), *followed][-1]
            megabytes = 1e-6 * (usage.limits.bytes_read - usage.left('bytes_read'))
            before, told = told, (f'read {megabytes:.1f} MB and {sum(map(len, usage.elements)):,} '
                                  f'elements of {printable(path)}')
            if told != before:
                # It is cut at the border; what comes next replaces it, even after a kill.
                os.write(terminal, f'\x1b[K\x1b[?7l{told}\x1b[?7h\r'.encode())
        if told:
            os.write(terminal, b'\x1b[K')

    thread, before = threading.Thread(target=tell, daemon=True), FOLLOWED.set(followed)
    thread.start()
    try:
        yield
    finally:
        FOLLOWED.reset(before)
        has_ended.set()
        thread.join()


def load_file(
    path: str, options: argparse.Namespace, **parts: bool,
) -> tuple[Scene | None, tuple[SdfError, ...], tuple[SdfWarning, ...]]:
    """Load a file as :func:`scene_from_file`; return the scene or None, errors and warnings."""
    try:
        scene = scene_from_file(path, options, **parts)
    except SdfError as error:
        return None, error.errors, error.warnings
    return scene, (), scene.warnings


def scene_of(path: str, options: argparse.Namespace, **parts: bool) -> Scene:
    """Load a file as :func:`scene_from_file`, and print its warnings to standard error."""
    scene = scene_from_file(path, options, **parts)
    print_problems((), scene.warnings, sys.stderr)
    return scene


def doubts_about_frames(scene: Scene, options: TfOptions | None = None) -> tuple[SdfWarning, ...]:
    """Return the warnings about the frames that the node publishes, by default without options."""
    # An error of the tree is a warning, as with other parameters the tree may be valid.
    try:
        return tf_tree_from_scene(scene, options).warnings
    except SdfError as error:
        return tuple(
            SdfWarning(each.code, f'{each.message}; by default, the node rejects this', each.place)
            for each in error.errors)


def sdf_name(scene: Scene, name: str) -> str:
    """
    Return the name in SDF of a frame; the given one of an optical frame, which is not in SDF.

    :raises UnknownFrameError: if there is no such frame.
    """
    if not name or scene.has(name):
        return name
    lookup = lookup_from_scene(scene)
    if not lookup.is_frame_id(name) and scene.elements_called(name):
        return name
    element, in_element = lookup.element(name)
    return scene.names[element] if in_element == Pose() else name
