# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose diff``: print what has changed in TF between two files."""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Sequence
import math
import sys

from sdf_pose_bridge.cli.arguments import (
    add_format_argument,
    add_kinds_argument,
    add_loading_arguments,
    add_reference_argument,
    add_unit_arguments,
    argument_type,
)
from sdf_pose_bridge.cli.frames import MOST_MOVED, print_csv, print_table, TableRow
from sdf_pose_bridge.cli.input_files import load_file, sdf_name
from sdf_pose_bridge.cli.printing import print_json, print_problems
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.geometry.poses import TOLERANCE
from sdf_pose_bridge.geometry.units import Units
from sdf_pose_bridge.printed_text import listed
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.comparison import Change, Difference, differences_of_scenes
from sdf_pose_bridge.tf.tree import DEFAULT_KINDS

HELP = 'print the changes of TF between two files'
DESCRIPTION = (
    'Compare what TF depends on in two files: print the elements that were added, '
    'removed, renamed or moved, and other parents in TF, types, axes, limits and '
    'mimics of joints, and frame ids of sensors, with what it was. The exit code '
    'is 1 if there is a change, 2 if a file has an error.')


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument('old', metavar='OLD', help='an SDFormat file; - reads the standard input')
    parser.add_argument('new', metavar='NEW', help='the file to compare it with')
    add_loading_arguments(parser)
    add_format_argument(parser, 'csv', 'json')
    add_reference_argument(parser, 'compare')
    parser.add_argument(
        '--tolerance', metavar='T', default=TOLERANCE, type=argument_type(
            float, 'is not a distance', lambda tolerance: 0.0 <= tolerance < math.inf),
        help='the largest difference of numbers that is none, in metres and radians; by default '
             f'{TOLERANCE:g}')
    add_kinds_argument(parser, 'compare only', DEFAULT_KINDS | {Kind.JOINT})
    add_unit_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Compare two files; return 0 for no difference, 1 for one, 2 if a file has an error."""
    (old, errors, warnings), (new, more_errors, more_warnings) = (
        load_file(path, options) for path in (options.old, options.new))
    errors, warnings = errors + more_errors, warnings + more_warnings
    differences: list[Difference] = []
    if old is not None and new is not None:
        try:
            differences = [
                difference for difference in differences_of_scenes(
                    old, new, relative_to=sdf_name(old, options.relative_to),
                    tolerance=options.tolerance)
                if difference.kind in options.kinds]
        except SdfError as error:
            errors = error.errors
    records = [
        {**difference._asdict(), 'change': difference.change.value, 'kind': difference.kind.label}
        for difference in differences]
    if options.format == 'json':
        print_json(options.new, errors, warnings, old=options.old, differences=records)
    else:
        print_problems(errors, warnings, sys.stderr)
    if options.format == 'csv':
        print(*Difference._fields, sep=',')
        print_csv(Difference._fields, records)
    elif options.format == 'text' and differences:
        units = Units(options.length_unit, options.angle_unit)
        followers = defaultdict[str, list[str]](list)
        for each in differences:
            followers[each.moved_with].append(each.name)
        moved = {each.name for each in differences if each.change is Change.MOVED}
        print_table(
            ('change', f'distance {units.length.name}', f'angle {units.angle.name}'),
            [_table_row(each, units, followers.get(each.name, ())) for each in differences
             if each.moved_with not in moved], 'was')
    return 2 if errors else 1 if differences else 0


def _table_row(difference: Difference, units: Units, followers: Sequence[str]) -> TableRow:
    change, old, note = difference.change, difference.old, ''
    values = [change.value, '', '']
    if change is Change.MOVED:
        numbers = difference.distance_m, difference.angle_rad, *map(float, old.split())
        texts = [f'{round(value, 9) * unit.factor + 0.0:.6g}' for value, unit in zip(
            numbers, (*units, *units.of_pose), strict=True)]
        values[1:], old = texts[:2], ' '.join(texts[2:])
        note = f'with it: {listed(followers, MOST_MOVED)}' if followers else ''
    elif change not in (Change.ADDED, Change.REMOVED, Change.RENAMED):
        old = f'{old}, now {difference.new}'
    return TableRow(difference.name, difference.kind.label, values, note, remark=old)
