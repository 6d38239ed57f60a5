# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose tree``: print the TF tree of files, or their elements by scope, with poses."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Sequence
from fnmatch import fnmatchcase
from itertools import compress
import math
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.cli.loading import (
    add_file_arguments,
    add_frame_arguments,
    print_frames,
    SHOWN_KINDS,
    tf_options_from_arguments,
)
from sdf_pose_bridge.cli.printing import (
    add_format_argument,
    add_unit_arguments,
    BELOW,
    Frame,
    kind_labels_of,
    TableRow,
)
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.scene.scene import Joint, Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.parents import NO_PARENT
from sdf_pose_bridge.tf.tree import DEFAULT_KINDS, elements_in_model, tf_tree_from_scene

_WIDEST_INDENT = 60


class _Row(NamedTuple):
    name: str
    """The name in a table."""
    full_name: str
    kind: str
    parent: int
    """Index of the row of the parent; -1 for none."""
    pose: Pose | None
    note: str = ''


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command."""
    parser = subparsers.add_parser(
        'tree', help='print the TF tree of files, or their elements by scope',
        description='Print the TF tree of files: each frame below its parent, with its kind and '
                    'its pose in the parent, x y z roll pitch yaw. The exit code is 1 if a file '
                    'has an error.')
    add_file_arguments(parser)
    add_format_argument(parser, 'csv', 'json')
    parser.add_argument(
        '--scope', action='store_true',
        help='print elements as they are nested in the file, of all kinds unless --kinds is '
             'given, with poses in the frames that they are relative to')
    add_frame_arguments(parser)
    add_unit_arguments(parser, 'degrees')
    parser.add_argument(
        '--depth', metavar='N', type=_depth_from_text, default=math.inf,
        help='print N levels below the root, and the number of frames below them')
    parser.add_argument(
        '--match', metavar='GLOB', default='',
        help='print only frames whose whole name matches, such as "*tool*", and those above them')
    parser.set_defaults(run=run, kinds=())


def run(options: argparse.Namespace) -> int:
    """
    Print the trees of files; continue after an invalid file.

    :return: exit code: 0 if all files are valid, else 1.
    """
    options.kinds = options.kinds or (SHOWN_KINDS if options.scope else DEFAULT_KINDS)
    return print_frames(
        options, 'frames', ('file', 'name', 'kind', 'parent', *Pose._fields, 'note'),
        _elements_by_scope if options.scope else _frames_of_tf, options.match)


def _depth_from_text(text: str) -> int:
    if not text.isdecimal():
        msg = f'"{text}" is not a number of levels'
        raise argparse.ArgumentTypeError(msg)
    return int(text)


def _frames_of_tf(
    scene: Scene, options: argparse.Namespace, warnings: list[SdfWarning],
) -> list[Frame]:
    tree = tf_tree_from_scene(scene, tf_options_from_arguments(options))
    warnings += tree.warnings
    # The root frame is row 0, so the index of a row is the index of its frame plus one.
    rows = [_Row(tree.root_frame, tree.root_frame, 'root', -1, None)]
    for frame_id, kind, parent, pose in zip(
            tree.frame_ids, kind_labels_of(scene, tree), tree.parents.tolist(),
            tree.transforms.tolist(), strict=True):
        has_parent = parent != NO_PARENT
        rows.append(_Row(
            frame_id, frame_id, kind, parent + 1 if has_parent else -1,
            Pose(*pose) if has_parent else None))
    return _in_branches(rows, options)


def _elements_by_scope(
    scene: Scene, options: argparse.Namespace, _warnings: list[SdfWarning],
) -> list[Frame]:
    """Return the elements of all worlds as they are nested."""
    joints = {joint.element: joint for joint in scene.joints}
    is_shown = (scene.parents < 0) | (
        elements_in_model(scene, options.model) & np.isin(scene.kinds, options.kinds))
    rows: list[_Row] = []
    # Children of a hidden element are shown below its nearest shown ancestor. The last entry is
    # for the parent -1.
    indices = [-1] * (len(scene.names) + 1)
    for element, parent in enumerate(scene.parents.tolist()):
        indices[element] = indices[parent]
        if is_shown[element]:
            reference = int(scene.references[element])
            rows.append(_Row(
                scene.own_name(element), scene.names[element], Kind(scene.kinds[element]).label,
                indices[parent],
                None if reference < 0 else scene.relative_pose_of(element, reference),
                _note(scene, element, joints.get(element))))
            indices[element] = len(rows) - 1
    return _in_branches(rows, options)


def _note(scene: Scene, element: int, joint: Joint | None) -> str:
    """Return further facts about the place of an element."""
    names, default = scene.names, scene.default_references[element]
    parts = []
    if joint is not None:
        parts.append(f'{joint.type}: {names[joint.parent]} -> {names[joint.child]}')
    elif scene.kinds[element] == Kind.FRAME and default != scene.parents[element]:
        parts.append(f'attached to {names[default]}')
    if scene.references[element] != default:
        parts.append(f'relative to {names[scene.references[element]]}')
    return ', '.join(parts)


def _in_branches(
    rows: Sequence[_Row], options: argparse.Namespace,
) -> list[Frame]:
    """Walk the rows from parents to children, in the order of the file, without recursion."""
    is_match = [fnmatchcase(row.full_name, options.match) for row in rows]
    is_shown = [not options.match] * len(rows)
    for index in compress(range(len(rows)), is_match):
        while index >= 0 and not is_shown[index]:
            is_shown[index] = True
            index = rows[index].parent
    children: dict[int, list[int]] = {}
    for index, row in enumerate(rows):
        if is_shown[index]:
            children.setdefault(row.parent, []).append(index)
    if not children.get(0) and len(children.get(-1, ())) > 1:
        # Nothing is below the root frame, as in the file of a robot that odometry places.
        children[-1].remove(0)
    lines: list[tuple[int, str]] = []
    # How many rows below each line are too deep to be printed.
    hidden: Counter[int] = Counter()
    waiting = [(index, 0, '') for index in reversed(children.get(-1, ()))]
    while waiting:
        index, depth, branches = waiting.pop()
        if depth > options.depth:
            hidden[len(lines)] += 1
        else:
            lines.append((index, branches))
        # A chain of thousands of links would be indented by thousands of characters.
        indent = branches.translate(BELOW)[-_WIDEST_INDENT:]
        below = children.get(index, [])
        waiting += [
            (child, depth + 1, indent + ('└ ' if child == below[-1] else '├ '))
            for child in reversed(below)]
    frames: list[Frame] = []
    for number, (index, branches) in enumerate(lines, start=1):
        name, full_name, kind, parent, pose, note = rows[index]
        more = f'{hidden[number]} more below' if hidden[number] else ''
        frames.append((
            {'name': full_name, 'kind': kind,
             'parent': rows[parent].full_name if parent >= 0 else None, 'pose': pose,
             'note': note},
            TableRow(name, kind, (), ', '.join(filter(None, (note, more))), branches,
                     is_match[index])))
    return frames
