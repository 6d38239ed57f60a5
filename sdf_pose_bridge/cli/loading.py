# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Load the files of a command, and choose their frames, by its arguments."""

from __future__ import annotations

import argparse
from collections.abc import Collection, Iterator, Mapping
import contextlib
from pathlib import Path
import sys
import threading
from typing import NamedTuple

from sdf_pose_bridge.cli.printing import add_unit_arguments, print_problems, RADIANS, Unit
from sdf_pose_bridge.errors import SdfError, SdfWarning
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.limits import Usage
from sdf_pose_bridge.sdformat.xml_file import bytes_from_file
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.tree import DEFAULT_KINDS, tf_tree_from_scene, TfOptions

SHOWN_KINDS = tuple(kind for kind in Kind if kind not in (Kind.ROOT, Kind.WORLD))
"""The kinds that ``--kinds`` accepts."""

STANDARD_INPUT = '-'
"""The argument for the standard input."""

_SHOWN_BY_NAME = {kind.label: kind for kind in SHOWN_KINDS}
_KIND_NAMES = ', '.join(_SHOWN_BY_NAME)


class LoadedFile(NamedTuple):
    """Result of loading a file."""

    scene: Scene | None
    """None if the file is not valid."""
    errors: tuple[SdfError, ...]
    warnings: tuple[SdfWarning, ...]


def add_file_arguments(parser: argparse.ArgumentParser, *, takes_many: bool = True) -> None:
    """
    Add the files of a command, and the arguments of :func:`load_file`.

    :param takes_many: whether the command takes several files.
    """
    parser.add_argument(
        'files', metavar='FILE', nargs='+' if takes_many else 1,
        help='an SDFormat file; - reads the standard input')
    add_loading_arguments(parser)


def add_loading_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of :func:`load_file`."""
    parser.add_argument(
        '-I', dest='resource_paths', metavar='DIR', type=_directory_from_text, action='append',
        default=[],
        help='a directory to search for included models, before GZ_SIM_RESOURCE_PATH '
             'and SDF_PATH; may be given more than once')
    parser.add_argument(
        '--skip-missing', action='store_true',
        help='leave out includes that are not found, with a warning')


def scene_from_file(
    path: str, options: argparse.Namespace, *, shapes: bool = False,
    texts: Mapping[str, bytes] | None = None,
) -> Scene:
    """
    Load a file, or a pipe such as the shell's ``<(command)``.

    :param path: path of the file; ``-`` for the standard input, beside which includes are searched
        in the working directory.
    :param texts: texts to read instead of some files, by their paths.
    :raises SdfError: if the file is not valid.
    """
    is_input = path == STANDARD_INPUT
    with _told_after_a_second(path):
        text = bytes_from_file('/dev/stdin' if is_input else path, Usage(), allows_pipe=True)
        return load_text(
            text, '<stdin>' if is_input else path,
            resource_paths=options.resource_paths, shapes=shapes, texts=texts,
            on_missing_include='skip' if options.skip_missing else 'error')


@contextlib.contextmanager
def _told_after_a_second(path: str) -> Iterator[None]:
    """Print to a terminal that a file is being read, if this takes longer than a second."""
    if not sys.stderr.isatty():
        yield
        return
    timer = threading.Timer(
        1.0, print, (f'reading {printable(path)} ...',), {'file': sys.stderr})
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def load_file(path: str, options: argparse.Namespace, *, shapes: bool = False) -> LoadedFile:
    """
    Load a file as :func:`scene_from_file` does.

    :return: the scene with its warnings, or the errors of the file.
    """
    try:
        scene = scene_from_file(path, options, shapes=shapes)
    except SdfError as error:
        return LoadedFile(None, error.errors, error.warnings)
    return LoadedFile(scene, (), scene.warnings)


def scene_of(path: str, options: argparse.Namespace, *, shapes: bool = False) -> Scene:
    """
    Load a file as :func:`scene_from_file` does, and print its warnings to standard error.

    :raises SdfError: if the file is not valid.
    """
    scene = scene_from_file(path, options, shapes=shapes)
    print_problems((), scene.warnings, sys.stderr)
    return scene


def pose_lookup(scene: Scene) -> PoseLookup:
    """Return a lookup by the names of SDF and of TF, as far as the names of TF are unique."""
    try:
        tree = tf_tree_from_scene(scene)
    except SdfError:
        # Frames that would share an id keep their names in SDF.
        tree = tf_tree_from_scene(scene, TfOptions(kinds=frozenset()))
    return PoseLookup(scene, tree)


def sdf_name(scene: Scene, name: str) -> str:
    """Return the name in SDF of a frame; the name as it is given if no frame of TF has it."""
    if not name or scene.has(name):
        return name
    lookup = pose_lookup(scene)
    if not lookup.is_frame_id(name):
        return name
    element, in_element = lookup.element(name)
    # The optical frame of a camera is not in SDF.
    return scene.names[element] if in_element == Pose() else name


def add_kinds_argument(
    parser: argparse.ArgumentParser, what: str, default: Collection[Kind] = SHOWN_KINDS,
) -> None:
    """
    Add the argument ``--kinds``, a list of kinds.

    :param what: the beginning of the help, such as ``print only``.
    :param default: the kinds without the argument.
    """
    labels = ','.join(kind.label for kind in SHOWN_KINDS if kind in default)
    instead = '' if default is SHOWN_KINDS else f'instead of {labels} '
    parser.add_argument(
        '--kinds', metavar='KIND[,KIND...]', type=_kinds_from_text, default=tuple(default),
        help=f'{instead}{what} these kinds: {_KIND_NAMES}')


def add_frame_arguments(parser: argparse.ArgumentParser, angle: Unit = RADIANS) -> None:
    """
    Add the arguments of :func:`tf_options_from_arguments`, and the units of poses.

    The first are named like parameters of the node.

    :param angle: the unit of angles without an argument.
    """
    add_kinds_argument(parser, 'show frames of', DEFAULT_KINDS)
    add_model_argument(parser)
    add_naming_argument(parser)
    add_unit_arguments(parser, angle)


def add_model_argument(parser: argparse.ArgumentParser, verb: str = 'show') -> None:
    """
    Add the argument ``--model``.

    :param verb: the verb of the help.
    """
    parser.add_argument(
        '--model', metavar='NAME', default='', help=f'{verb} only this model, such as robot::arm')


def add_naming_argument(parser: argparse.ArgumentParser) -> None:
    """Add the argument ``--frame-names``."""
    parser.add_argument(
        '--frame-names', choices=[names.value for names in FrameNames],
        default=FrameNames.AUTO.value,
        help='scoped: frame ids with the names of all models around an element; relative: '
             'without the top-level model; auto: relative for a model file')


def tf_options_from_arguments(options: argparse.Namespace) -> TfOptions:
    """Return the elements that become frames, and the rules for their names."""
    return TfOptions(
        model=options.model, kinds=frozenset(options.kinds),
        frame_names=FrameNames(options.frame_names))


def _directory_from_text(text: str) -> str:
    if not Path(text).is_dir():
        msg = f'"{text}" is not a directory'
        raise argparse.ArgumentTypeError(msg)
    return text


def _kinds_from_text(text: str) -> tuple[Kind, ...]:
    names = text.split(',')
    for name in names:
        if name not in _SHOWN_BY_NAME:
            msg = f'"{name}" is not a kind of element; known are {_KIND_NAMES}'
            raise argparse.ArgumentTypeError(msg)
    return tuple(map(_SHOWN_BY_NAME.__getitem__, names))
