# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The names in texts of poses, by the formats that they say."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
import re
from typing import NamedTuple

from sdf_pose_bridge.geometry.formats import Format, POSE_FORMATS, ROTATION_FORMATS
from sdf_pose_bridge.geometry.named_numbers import is_number, Named, SCALARS


class Names(NamedTuple):
    """Names that say what a position or a rotation is."""

    names: tuple[str, ...]
    """In the order of the numbers; ``a.b`` is b in a."""
    width: int
    """How many numbers each has."""
    format: str
    """The name in :data:`FORMATS` of a pose with this rotation; ``euler`` for MJCF's own."""
    numbers: Sequence[str]
    """In the tables, those for missing names if they may be missing; in a text, its own."""


def names_of(text: str, pose_format: str = '', missing: str = '') -> Names:
    """Return names; one with ``*3`` has three numbers."""
    names, _, count = text.partition('*')
    return Names((names,) if count else (*text.split(),), int(count or 1), pose_format,
                 missing.split())


# The tables

_RPY, _XYZW, _MATRIX = 'sdf_rpy', 'sdf_quat_xyzw', 'a position and a matrix'
POSITIONS = (
    names_of('x y z'), names_of('position.x position.y position.z', missing='0 0 0'),
    names_of('position*3'), names_of('@pos*3'), names_of('t*3'), names_of('T*3'),
    names_of('--x --y --z', missing='0 0 0'))
ROTATIONS = (
    names_of('X Y Z A B C', 'kuka_abc'), names_of('X Y Z W P R', 'fanuc_wpr'),
    names_of('roll pitch yaw', _RPY), names_of('rpy*3', _RPY),
    names_of('rpy.roll rpy.pitch rpy.yaw', _RPY),
    names_of('orientation.roll orientation.pitch orientation.yaw', _RPY),
    names_of('qx qy qz qw', _XYZW),
    names_of('orientation.qx orientation.qy orientation.qz orientation.qw', _XYZW),
    names_of('orientation.x orientation.y orientation.z orientation.w', _XYZW, '0 0 0 1'),
    names_of('orientation.in quaternion*4', _XYZW),
    names_of('orientation.in quaternion (xyzw)*4', _XYZW),
    names_of('quat_xyzw*4', _XYZW), names_of('quat_wxyz*4', 'mujoco'),
    names_of('@quat*4', 'mujoco'), names_of('@euler*3', 'euler'),
    names_of('orientation*9', _MATRIX), names_of('R*9', _MATRIX),
    names_of('--roll --pitch --yaw', _RPY, '0 0 0'),
    names_of('--qx --qy --qz --qw', _XYZW, '0 0 0 1'))
"""Each with each position, but for those of makers. Names with @ are attributes of MJCF."""
QUATERNION = [names_of('x y z w', 'quaternion')]
"""A rotation alone."""

_SYNONYMS = {
    **dict.fromkeys('translation xyz pos trans point vector3'.split(), 'position'),
    **dict.fromkeys('rotation quaternion quat rot'.split(), 'orientation')}
PUBLISHER = 'static_transform_publisher'
CALLS = {
    'p': ('p[...] of Universal Robots', 'ur_pose'), 'posx': ('posx(...) of Doosan', 'doosan'),
    'TRANS': ('TRANS(...) of Kawasaki', 'kawasaki_oat'),
    PUBLISHER: (PUBLISHER, 'x y z yaw pitch roll', _XYZW)}
"""For each name before numbers, a text for people and the formats of these numbers."""
MATRICES = {9: ROTATION_FORMATS['matrix']} | dict.fromkeys(
    (12, 16), POSE_FORMATS['matrix_row_major'])
"""The formats of numbers behind any other name, by their count."""
FORMATS: Mapping[str, Format] = {
    **POSE_FORMATS, 'quaternion': ROTATION_FORMATS['quaternion'],
    'x y z yaw pitch roll': POSE_FORMATS[_RPY]._replace(columns=(3, 4, 5)),
    _MATRIX: MATRICES[16]._replace(position=(0, 1, 2), columns=(*range(3, 12),), last_row=())}
TEXTS = {
    'kuka_abc': '{X ...} of KUKA', 'fanuc_wpr': 'a position of FANUC', 'quaternion': 'x y z w'}
"""Texts for people about names that have all numbers of a format."""
COLUMN_MAJOR = re.compile('(O|F|EE|NE)_T_(EE|NE|K)(_[cd])?')
"""Names of matrices in messages of libfranka."""
_IN_LIST = r'\[\s*[^\[\],]+' + r'(?:,[^\[\],]+)'
FRAME_OF_ABB = re.compile(
    rf'\[\s*({_IN_LIST}{{2}}\]\s*,\s*{_IN_LIST}{{3}}\])'
    rf'(\s*,\s*{_IN_LIST}{{3}}\]\s*,\s*{_IN_LIST}{{5}}\]\s*\])?')
"""A position and a quaternion; in a robtarget, followed by axes."""
PARTS_OF_ECHO = {'Translation', 'Rotation', 'Matrix'}
"""The names of items of a list in which tf2_echo prints one pose."""

BESIDE = re.compile(
    r'(id|seq|header|stamp|time|timestamp|at time|.*covariance|matrix|orientation\.in rpy.*'
    r'|S|T|e[1-6])(\..*)?|(.*\.)?(rows|cols|uf|ut)')
BESIDE_MJCF = re.compile('size|mass|density|fovy|rgba|group|diaginertia')
"""Names of numbers beside a pose that do not change it."""
NO_POSE = re.compile('.*covariance|.*intrinsics?.*|camera_?matrix|k|.*distortion.*|.*inertia')
CHANGES = re.compile('.*(unit|scale|degree|radian|order|convention|euler|sequence).*')
"""Names of words that may say what numbers are."""
OF_ROS = 'position', 'translation', 'orientation', 'rotation'
"""The names in messages of ROS and protobuf, in which numbers may be missing."""
UNIT = re.compile('(.*_)?units?')
UNITS = {
    **dict.fromkeys('m metre metres meter meters'.split(), 'm'), 'mm': 'mm',
    **dict.fromkeys('deg degree degrees'.split(), 'deg'),
    **dict.fromkeys('rad radian radians'.split(), 'rad')}
KNOWN = {name for part in (*POSITIONS, *ROTATIONS) for name in part.names} | {
    'args', 'arguments', 'position'}


@lru_cache(maxsize=1000)
def name_in_tables(name: str, *, is_attribute: bool = False) -> str:
    """Return the name in the tables for a name of a text, perhaps with one around it."""
    if name.startswith('--'):
        return name
    parts = [each if len(each) == 1 else each.lower() for each in re.split(r'(?:\.|::|/)+', name)]
    if is_attribute and parts[-1] in ('pos', 'quat', 'euler'):
        return f'@{parts[-1]}'
    if parts[-1] in SCALARS and parts[1:]:
        return f'{_SYNONYMS.get(parts[-2], parts[-2])}.{parts[-1]}'
    return _SYNONYMS.get(parts[-1], parts[-1])


def numbers_of(named: Named) -> tuple[Sequence[str], str]:
    """Return the numbers of a name, none if there are other words, and the unit behind them."""
    words, unit = named.words, ''
    while words and (words[0] == ':' or (
            words[0].startswith('(') and UNITS.keys().isdisjoint(words[0][1:-1].split()))):
        words = words[1:]
    if words[1:] and words[-1] in UNITS:
        words, unit = words[:-1], UNITS[words[-1]]
    return (words if all(map(is_number, words)) else (), unit)
