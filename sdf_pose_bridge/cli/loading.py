# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Load the files of a command, and choose and print their frames, by its arguments."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Collection, Mapping, Sequence
import os
import sys
import threading

from sdf_pose_bridge.cli.printing import (
    argument_type,
    Frame,
    print_csv,
    print_json,
    print_problems,
    print_table,
)
from sdf_pose_bridge.errors import SdfError, SdfWarning
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.units import Units
from sdf_pose_bridge.names import hint_from_names, printable
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


def add_file_arguments(parser: argparse.ArgumentParser, *, takes_many: bool = True) -> None:
    """Add the file or the files of a command, and the arguments of :func:`load_file`."""
    parser.add_argument(
        'files', metavar='FILE', nargs='+' if takes_many else 1,
        help='an SDFormat file; - reads the standard input')
    add_loading_arguments(parser)


def add_loading_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of :func:`load_file`."""
    parser.add_argument(
        '-I', dest='resource_paths', metavar='DIR', action='append', default=[],
        type=argument_type(str, os.path.isdir, 'is not a directory'),
        help='a directory to search for included models, before GZ_SIM_RESOURCE_PATH '
             'and SDF_PATH; may be given more than once')
    parser.add_argument(
        '--skip-missing', action='store_true',
        help='leave out includes that are not found, with a warning')


def scene_from_file(
    path: str, options: argparse.Namespace, texts: Mapping[str, bytes] | None = None, *,
    shapes: bool = False,
) -> Scene:
    """
    Load a file, or a pipe such as the shell's ``<(command)``.

    :param path: path of the file; ``-`` for the standard input, beside which includes are searched
        in the working directory.
    :param texts: texts to read instead of some files, by their paths.
    :raises SdfError: if the file is not valid.
    """
    is_input = path == STANDARD_INPUT
    # Tells people why nothing happens.
    timer = threading.Timer(
        1.0, print, (f'reading {printable(path)} ...',), {'file': sys.stderr})
    if sys.stderr.isatty():
        timer.start()
    try:
        text = bytes_from_file('/dev/stdin' if is_input else path, Usage(), allows_pipe=True)
        return load_text(
            text, '<stdin>' if is_input else path,
            resource_paths=options.resource_paths, shapes=shapes, texts=texts,
            on_missing_include='skip' if options.skip_missing else 'error')
    finally:
        timer.cancel()


def load_file(
    path: str, options: argparse.Namespace, *, shapes: bool = False,
) -> tuple[Scene | None, tuple[SdfError, ...], tuple[SdfWarning, ...]]:
    """Load a file as :func:`scene_from_file`; return the scene or None, errors and warnings."""
    try:
        scene = scene_from_file(path, options, shapes=shapes)
    except SdfError as error:
        return None, error.errors, error.warnings
    return scene, (), scene.warnings


def scene_of(path: str, options: argparse.Namespace, *, shapes: bool = False) -> Scene:
    """Load a file as :func:`scene_from_file`, and print its warnings to standard error."""
    scene = scene_from_file(path, options, shapes=shapes)
    print_problems((), scene.warnings, sys.stderr)
    return scene


def print_frames(
    options: argparse.Namespace, member: str, columns: Sequence[str],
    frames_of_scene: Callable[[Scene, argparse.Namespace, list[SdfWarning]], Sequence[Frame]],
    pattern: str = '',
) -> int:
    """
    Print the frames of files; continue after an invalid file.

    :param member: the member of the JSON object that has the records.
    :param columns: the columns of CSV: ``file``, members of the records, and numbers of poses.
    :param frames_of_scene: returns the record of each frame, whose member ``pose`` is None if it
        has no pose, and its row in a table without the pose; adds warnings to those of the file.
    :param pattern: the pattern of names that the frames match, for a message if there are none.
    :return: exit code: 0 if all files are valid, else 1.
    """
    exit_code, units = 0, Units(options.length_unit, options.angle_unit)
    if options.format == 'csv':
        print(*columns, sep=',')
    for path in options.files:
        scene, errors, (*warnings,) = load_file(path, options)
        frames: Sequence[Frame] = ()
        if scene is not None:
            try:
                frames = frames_of_scene(scene, options, warnings)
            except SdfError as error:
                errors = error.errors
        exit_code |= bool(errors)
        if options.format == 'json':
            print_json(path, errors, warnings, **{member: [record for record, _ in frames]})
            continue
        print_problems(errors, warnings, sys.stderr)
        if options.format == 'csv':
            print_csv(columns, (
                {'file': path, **record, **(record['pose']._asdict() if record['pose'] else {})}
                for record, _ in frames))
        elif not errors:
            if len(options.files) > 1:
                print(printable(path))
            if pattern and not frames:
                print(f'sdf_pose {options.command}: no whole name in {printable(path)} matches '
                      f'"{printable(pattern)}"', file=sys.stderr)
                continue
            print_table(units.labels, [
                row._replace(values=units.texts(record['pose'], fewer_digits=1))
                if record['pose'] else row for record, row in frames])
    return exit_code


def pose_lookup(scene: Scene) -> PoseLookup:
    """Return a lookup by the names of SDF, and by those of TF if these are unique."""
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
    """Add the argument ``--kinds``; ``what`` is its purpose, such as ``print only``."""
    labels = ','.join(kind.label for kind in SHOWN_KINDS if kind in default)
    instead = '' if default is SHOWN_KINDS else f'instead of {labels} '
    parser.add_argument(
        '--kinds', metavar='KIND[,KIND...]', type=_kinds_from_text, default=tuple(default),
        help=f'{instead}{what} these kinds: {_KIND_NAMES}')


def add_frame_arguments(
    parser: argparse.ArgumentParser, what: str = 'show frames of', verb: str = 'show',
) -> None:
    """Add the arguments of :func:`tf_options_from_arguments`, named as parameters of the node."""
    add_kinds_argument(parser, what, DEFAULT_KINDS)
    add_model_argument(parser, verb)
    parser.add_argument(
        '--frame-names', choices=[names.value for names in FrameNames],
        default=FrameNames.AUTO.value,
        help='scoped: frame ids with the names of all models around an element; relative: '
             'without the top-level model; auto: relative for a model file')


def add_model_argument(parser: argparse.ArgumentParser, verb: str = 'show') -> None:
    """Add the argument ``--model``, whose help begins with a verb."""
    parser.add_argument(
        '--model', metavar='NAME', default='', help=f'{verb} only this model, such as robot::arm')


def tf_options_from_arguments(options: argparse.Namespace) -> TfOptions:
    """Return the elements that become frames, and the rules for their names."""
    return TfOptions(
        model=options.model, kinds=frozenset(options.kinds),
        frame_names=FrameNames(options.frame_names))


def _kinds_from_text(text: str) -> tuple[Kind, ...]:
    try:
        return tuple(_SHOWN_BY_NAME[name] for name in text.split(','))
    except KeyError as error:
        hint = hint_from_names(error.args[0], _SHOWN_BY_NAME)
        msg = f'"{error.args[0]}" is not a kind of element; known are {_KIND_NAMES}{hint}'
        raise argparse.ArgumentTypeError(msg) from None
