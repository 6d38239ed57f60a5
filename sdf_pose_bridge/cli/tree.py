# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose tree``: print the TF tree of files, or their elements by scope, with poses."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from fnmatch import fnmatchcase
from itertools import compress
import math

import numpy as np

from sdf_pose_bridge.cli.arguments import (
    add_digits_argument,
    add_file_arguments,
    add_format_argument,
    add_frame_arguments,
    add_unit_arguments,
    argument_type,
    SHOWN_KINDS,
    tf_options_from_arguments,
)
from sdf_pose_bridge.cli.frames import BELOW, Frame, print_frames, TableRow
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.scene.scene import Joint, Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.parents import ROOT_IS_PARENT
from sdf_pose_bridge.tf.tree import DEFAULT_KINDS, elements_in_model, tf_tree_from_scene

_WIDEST_INDENT = 60

HELP = 'print the TF tree of files, or their elements by scope'
DESCRIPTION = (
    'Print the TF tree of files: each frame below its parent, with its kind and '
    'its pose in the parent, x y z roll pitch yaw. The exit code is 1 if a file '
    'has an error.')


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_file_arguments(parser)
    add_format_argument(parser, 'csv', 'json')
    parser.add_argument(
        '--scope', action='store_true',
        help='print elements as they are nested in the file, of all kinds unless --kinds is '
             'given, with poses in the frames that they are relative to')
    add_frame_arguments(parser)
    add_unit_arguments(parser)
    add_digits_argument(parser)
    parser.add_argument(
        '--depth', metavar='N', default=math.inf,
        type=argument_type(int, 'is not a number of levels', lambda depth: depth >= 0),
        help='print N levels below the root, and the number of frames below them')
    parser.add_argument(
        '--match', metavar='GLOB', default='',
        help='print only frames whose whole name matches, such as "*tool*", and those above them')
    parser.set_defaults(kinds=())


def run(options: argparse.Namespace) -> int:
    """Print the trees of files; return 0 if all files are valid, else 1."""
    options.kinds = options.kinds or (SHOWN_KINDS if options.scope else DEFAULT_KINDS)
    return print_frames(
        options, 'frames', ('file', 'name', 'kind', 'parent', *Pose._fields, 'note'),
        _elements_by_scope if options.scope else _frames_of_tf, options.match)


def _frames_of_tf(
    scene: Scene, options: argparse.Namespace, warnings: list[SdfWarning],
) -> list[Frame]:
    tree = tf_tree_from_scene(scene, tf_options_from_arguments(options))
    warnings += tree.warnings
    # The root frame comes first, so the index of each parent is one more than in the tree.
    names = (tree.root_frame, *tree.frame_ids)
    kinds = ('root', *tree.kind_labels(scene))
    parents = [-1, *(tree.parents - ROOT_IS_PARENT).tolist()]
    return _in_branches([
        ({'name': name, 'kind': kind, 'parent': names[parent] if parent >= 0 else None,
          'pose': Pose(*pose) if parent >= 0 else None, 'note': ''}, TableRow(name, kind))
        for name, kind, parent, pose in zip(
            names, kinds, parents, ((), *tree.transforms.tolist()), strict=True)],
        parents, options)


def _elements_by_scope(
    scene: Scene, options: argparse.Namespace, _warnings: list[SdfWarning],
) -> list[Frame]:
    """Return the elements of all worlds as they are nested."""
    joints = {joint.element: joint for joint in scene.joints}
    is_shown = (scene.parents < 0) | (
        elements_in_model(scene, options.model) & np.isin(scene.kinds, options.kinds))
    frames: list[Frame] = []
    parents = []
    # Children of a hidden element are shown below its nearest shown ancestor. The last entry is
    # for the parent -1.
    indices = [-1] * (len(scene.names) + 1)
    for element, parent in enumerate(scene.parents.tolist()):
        index = indices[element] = indices[parent]
        if is_shown[element]:
            reference, kind = int(scene.references[element]), Kind(scene.kinds[element]).label
            indices[element] = len(frames)
            frames.append(({
                'name': scene.names[element], 'kind': kind,
                'parent': frames[index][0]['name'] if index >= 0 else None,
                'pose': None if reference < 0 else scene.relative_pose_of(element, reference),
                'note': _note(scene, element, joints.get(element)),
            }, TableRow(scene.own_name(element), kind)))
            parents.append(index)
    return _in_branches(frames, parents, options)


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
    frames: Sequence[Frame], parents: Sequence[int], options: argparse.Namespace,
) -> list[Frame]:
    """
    Walk the frames from parents to children, in the order of the file, without recursion.

    :param parents: the index of the parent of each frame; -1 for none.
    """
    is_match = [fnmatchcase(record['name'], options.match) for record, _ in frames]
    is_shown = [not options.match] * len(frames)
    for index in compress(range(len(frames)), is_match):
        while index >= 0 and not is_shown[index]:
            is_shown[index] = True
            index = parents[index]
    children: dict[int, list[int]] = {}
    for index in compress(range(len(frames)), is_shown):
        children.setdefault(parents[index], []).append(index)
    has_root_frame = frames[0][1].kind == 'root'
    if has_root_frame and not children.get(0) and len(children.get(-1, ())) > 1:
        # Nothing is below the root frame, as in the file of a robot that odometry places.
        children[-1].remove(0)
    found: list[Frame] = []
    # The number of frames below each line that are too deep to be printed.
    hidden: list[int] = []
    waiting = [(index, 0, '') for index in reversed(children.get(-1, ()))]
    while waiting:
        index, depth, branches = waiting.pop()
        if depth > options.depth:
            hidden[-1] += 1
        else:
            record, row = frames[index]
            found.append((record, row._replace(branches=branches, is_bold=is_match[index])))
            hidden.append(0)
        # A chain of thousands of links would be indented by thousands of characters.
        indent = branches.translate(BELOW)[-_WIDEST_INDENT:]
        below = children.get(index, [])
        waiting += [
            (child, depth + 1, indent + ('└ ' if child == below[-1] else '├ '))
            for child in reversed(below)]
    return [
        (record, row._replace(note=', '.join(filter(None, (
            record['note'], f'{count} more below' if count else '')))))
        for (record, row), count in zip(found, hidden, strict=True)]
