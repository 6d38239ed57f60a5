# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Arguments, loading and units of the commands that show frames."""

from __future__ import annotations

import argparse
from collections.abc import Collection
from collections.abc import Iterator
from collections.abc import Sequence
import contextlib
from pathlib import Path
import sys
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.cli.check import load_file
from sdf_pose_bridge.cli.check import print_problems
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.rotations import rpy_from_quaternion
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.tree import tf_tree_from_scene
from sdf_pose_bridge.tf.tree import TfOptions
from sdf_pose_bridge.tf.tree import TfTree

SHOWN_KINDS = tuple(kind for kind in Kind if kind not in (Kind.ROOT, Kind.WORLD))
"""The kinds that ``--kinds`` takes."""

_SHOWN_BY_NAME = {kind.label: kind for kind in SHOWN_KINDS}
_KIND_NAMES = ', '.join(_SHOWN_BY_NAME)
_DEGREES_PER_RADIAN = 57.29577951308232


class Units(NamedTuple):
    """Units of the poses that a command shows."""

    is_mm: bool
    """Whether lengths are in millimetres, not metres."""
    is_degrees: bool
    """Whether angles are in degrees, not radians."""

    @property
    def length(self) -> str:
        """Name of the unit of lengths."""
        return 'mm' if self.is_mm else 'm'

    @property
    def angle(self) -> str:
        """Name of the unit of angles."""
        return 'deg' if self.is_degrees else 'rad'

    def texts(self, pose: Pose) -> list[str]:
        """
        Write a pose in these units.

        :return: x, y, z, roll, pitch and yaw, rounded.
        """
        length, length_digits = (1000.0, 1) if self.is_mm else (1.0, 4)
        angle, angle_digits = (_DEGREES_PER_RADIAN, 2) if self.is_degrees else (1.0, 4)
        # To add zero leaves no negative zeros.
        return [
            *(f'{round(value * length, length_digits) + 0.0:.{length_digits}f}'
              for value in pose[:3]),
            *(f'{round(value * angle, angle_digits) + 0.0:.{angle_digits}f}'
              for value in rpy_from_quaternion(pose[3:]))]


def add_kinds_argument(
    parser: argparse.ArgumentParser, default: Collection[Kind], what: str = 'show only',
) -> None:
    """
    Add the argument ``--kinds``, a list of kinds.

    :param default: the kinds without the argument.
    :param what: what the command does with the kinds.
    """
    parser.add_argument(
        '--kinds', metavar='KIND[,KIND...]', type=_kinds_from_text, default=tuple(default),
        help=f'{what} these kinds: {_KIND_NAMES}')


def add_frame_arguments(
    parser: argparse.ArgumentParser, default_kinds: Collection[Kind],
) -> None:
    """
    Add the arguments of :func:`tf_tree_of`, which are named like the parameters of the node.

    :param default_kinds: the kinds of element that become frames without ``--kinds``.
    """
    names = ','.join(kind.label for kind in SHOWN_KINDS if kind in default_kinds)
    add_kinds_argument(parser, default_kinds, f'instead of {names} show frames of')
    add_model_argument(parser)
    parser.add_argument(
        '--frame-names', choices=[names.value for names in FrameNames],
        default=FrameNames.AUTO.value,
        help='scoped: the names of all models around an element are in its frame id; relative: '
             'all but that of the top-level model; auto: relative for a model file')


def add_model_argument(parser: argparse.ArgumentParser) -> None:
    """Add the argument ``--model``."""
    parser.add_argument(
        '--model', metavar='NAME', default='', help='show only this model, such as robot::arm')


def add_output_argument(
    parser: argparse.ArgumentParser, formats: Sequence[str], what: str,
) -> None:
    """
    Add the argument ``-o``, a path whose ending says the format.

    :param formats: the endings, such as ``.svg``.
    :param what: what is written there.
    """
    def path_from_text(text: str) -> Path:
        path = Path(text)
        if path.suffix.lower() not in formats:
            msg = f'"{text}" must end with one of {", ".join(formats)}'
            raise argparse.ArgumentTypeError(msg)
        return path

    parser.add_argument(
        '-o', dest='output', metavar='PATH', type=path_from_text, help=f'where to write {what}')


def add_unit_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of :func:`units_from_arguments`."""
    parser.add_argument('--degrees', action='store_true', help='angles in degrees, not radians')
    parser.add_argument('--mm', action='store_true', help='lengths in millimetres, not metres')


def units_from_arguments(options: argparse.Namespace) -> Units:
    """
    Return the units to show poses in.

    :return: the units.
    """
    return Units(options.mm, options.degrees)


def scene_of(path: str, options: argparse.Namespace, *, shapes: bool = False) -> Scene | None:
    """
    Load a file and print its errors and warnings to standard error.

    :return: the scene; None if the file is not valid.
    """
    loaded = load_file(path, options, shapes=shapes)
    sys.stdout.flush()
    print_problems(loaded.errors, loaded.warnings, sys.stderr)
    return loaded.scene


@contextlib.contextmanager
def printed_errors() -> Iterator[None]:
    """Print errors that are raised to standard error."""
    try:
        yield
    except SdfError as error:
        print_problems(error.errors, error.warnings, sys.stderr)


def tf_tree_of(scene: Scene, options: argparse.Namespace) -> TfTree:
    """
    Make the TF tree of a scene and print its warnings to standard error.

    :return: the tree.
    :raises SdfError: if there is none.
    """
    tree = tf_tree_from_scene(scene, TfOptions(
        model=options.model, kinds=frozenset(options.kinds),
        frame_names=FrameNames(options.frame_names)))
    print_problems((), tree.warnings, sys.stderr)
    return tree


def kind_labels_of(scene: Scene, tree: TfTree) -> list[str]:
    """
    Return the kind of each frame in words.

    :return: the labels of their kinds; ``optical frame`` for those of cameras.
    """
    return [
        'optical frame' if element < 0 else Kind(scene.kinds[element]).label
        for element in tree.elements.tolist()]


def default_references_of(scene: Scene) -> list[int]:
    """
    Return the frame that the pose of each element would be relative to without ``relative_to``.

    :return: of a joint its child, of an explicit frame what it is attached to, of another element
        the one that holds it; -1 for worlds and implicit roots.
    """
    references: list[int] = np.where(
        scene.kinds == int(Kind.FRAME), scene.attachments, scene.parents).tolist()
    for joint in scene.joints:
        references[joint.element] = joint.child
    return references


def _kinds_from_text(text: str) -> tuple[Kind, ...]:
    kinds = []
    for name in text.split(','):
        if name not in _SHOWN_BY_NAME:
            msg = f'"{name}" is not a kind of element; known are {_KIND_NAMES}'
            raise argparse.ArgumentTypeError(msg)
        kinds.append(_SHOWN_BY_NAME[name])
    return tuple(kinds)
