# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose tree``: print the TF tree of files, or their elements by scope, with poses."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from fnmatch import fnmatchcase
from itertools import compress
import math
import sys
from typing import Any, NamedTuple

import numpy as np

from sdf_pose_bridge.cli.loading import (
    add_file_arguments,
    add_frame_arguments,
    load_file,
    SHOWN_KINDS,
    tf_options_from_arguments,
)
from sdf_pose_bridge.cli.printing import (
    branches_of_tree,
    DEGREES,
    kind_labels_of,
    print_problems,
    print_table,
    TableRow,
    Units,
)
from sdf_pose_bridge.cli.records import (
    add_format_argument,
    CSV,
    JSON,
    print_csv,
    print_csv_header,
    print_json,
)
from sdf_pose_bridge.errors import SdfError, SdfWarning
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.scene.scene import Joint, Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.parents import NO_PARENT
from sdf_pose_bridge.tf.tree import DEFAULT_KINDS, elements_in_model, tf_tree_from_scene

_COLUMNS = ('file', 'name', 'kind', 'parent', 'x', 'y', 'z', 'qx', 'qy', 'qz', 'qw', 'note')
_WIDEST_INDENT = 60


class _Row(NamedTuple):
    name: str
    """The printed name."""
    full_name: str
    """The name that is compared with a pattern."""
    kind: str
    parent: int
    """Index of the row of the parent; -1 for none."""
    pose: Pose | None
    note: str = ''


class _Line(NamedTuple):
    branches: str
    row: _Row
    hidden: int
    """Number of rows below this one that are too deep to be printed."""
    is_match: bool


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command."""
    parser = subparsers.add_parser(
        'tree', help='print the TF tree of files, or their elements by scope',
        description='Print the TF tree of files: each frame below its parent, with its kind and '
                    'its pose in the parent, x y z roll pitch yaw. The exit code is 1 if a file '
                    'has an error.')
    add_file_arguments(parser)
    add_format_argument(parser, CSV, JSON)
    parser.add_argument(
        '--scope', action='store_true',
        help='print elements as they are nested in the file, of all kinds unless --kinds is '
             'given, with poses in the frames that they are relative to')
    add_frame_arguments(parser, DEGREES)
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
    exit_code = 0
    options.kinds = options.kinds or (SHOWN_KINDS if options.scope else DEFAULT_KINDS)
    if options.format == CSV:
        print_csv_header(_COLUMNS)
    for path in options.files:
        loaded = load_file(path, options)
        lines: list[_Line] = []
        if loaded.scene is not None:
            try:
                rows, warnings = (_rows_by_scope if options.scope else _rows_of_frames)(
                    loaded.scene, options)
                loaded = loaded._replace(warnings=loaded.warnings + warnings)
                lines = _lines(rows, options)
            except SdfError as error:
                loaded = loaded._replace(errors=error.errors)
        exit_code |= bool(loaded.errors)
        if options.format == JSON:
            print_json(
                path, loaded.errors, loaded.warnings,
                frames=[_record(line.row, rows) for line in lines])
            continue
        print_problems(loaded.errors, loaded.warnings, sys.stderr)
        if options.format == CSV:
            print_csv(_COLUMNS, (
                {'file': path, **record, **dict(
                    zip(_COLUMNS[4:], record['pose'] or (), strict=False))}
                for record in (_record(line.row, rows) for line in lines)))
        elif not loaded.errors:
            if len(options.files) > 1:
                print(printable(path))
            if lines:
                units = Units(options.length_unit, options.angle_unit)
                print_table(units.labels, [_table_row(line, units) for line in lines])
            else:
                print(f'sdf_pose tree: no whole name in {printable(path)} matches '
                      f'"{printable(options.match)}"', file=sys.stderr)
    return exit_code


def _table_row(line: _Line, units: Units) -> TableRow:
    branches, row, hidden, is_match = line
    notes = [row.note] if row.note else []
    notes += [f'{hidden} more below'] if hidden else []
    values = () if row.pose is None else units.texts(row.pose, fewer_digits=1)
    return TableRow(row.name, row.kind, values, notes, branches, is_match)


def _depth_from_text(text: str) -> int:
    if not text.isdecimal():
        msg = f'"{text}" is not a number of levels'
        raise argparse.ArgumentTypeError(msg)
    return int(text)


def _record(row: _Row, rows: Sequence[_Row]) -> dict[str, Any]:
    """Return a row with the name of its parent and its pose as x y z qx qy qz qw."""
    return {
        'name': row.full_name, 'kind': row.kind,
        'parent': rows[row.parent].full_name if row.parent >= 0 else None,
        'pose': row.pose, 'note': row.note}


def _rows_of_frames(
    scene: Scene, options: argparse.Namespace,
) -> tuple[list[_Row], tuple[SdfWarning, ...]]:
    tree = tf_tree_from_scene(scene, tf_options_from_arguments(options))
    root = _Row(tree.root_frame, tree.root_frame, 'root', -1, None)
    # The root frame is row 0, so the index of a row is the index of its frame plus one.
    return [root, *(
        _Row(frame_id, frame_id, kind, -1, None) if parent == NO_PARENT
        else _Row(frame_id, frame_id, kind, parent + 1, Pose(*pose))
        for frame_id, kind, parent, pose in zip(
            tree.frame_ids, kind_labels_of(scene, tree), tree.parents.tolist(),
            tree.transforms.tolist(), strict=True))], tree.warnings


def _rows_by_scope(
    scene: Scene, options: argparse.Namespace,
) -> tuple[list[_Row], tuple[SdfWarning, ...]]:
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
    return rows, ()


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


def _lines(rows: Sequence[_Row], options: argparse.Namespace) -> list[_Line]:
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
    tee, corner, bar, blank = branches_of_tree()
    lines: list[_Line] = []
    waiting = [(index, 0, '', '') for index in reversed(children.get(-1, ()))]
    while waiting:
        index, depth, indent, branch = waiting.pop()
        below = children.get(index, [])
        if depth > options.depth:
            lines[-1] = lines[-1]._replace(hidden=lines[-1].hidden + 1)
        else:
            lines.append(_Line(indent + branch, rows[index], 0, is_match[index]))
        if branch:
            # A chain of thousands of links would be indented by thousands of characters.
            indent = (indent + (blank if branch == corner else bar))[-_WIDEST_INDENT:]
        waiting += [
            (child, depth + 1, indent, corner if child == below[-1] else tee)
            for child in reversed(below)]
    return lines
