# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
What libsdformat gets wrong, and how the comparison goes round it.

The package follows libsdformat 14. Where the release that is installed is older or mistaken,
scenes avoid the construct, or the comparison passes over it; nothing else is forgiven.
"""

from __future__ import annotations

import enum
from typing import NamedTuple


class Remedy(enum.Enum):
    """How a defect is kept from being taken for one of the package."""

    NOT_DRAWN = 'no scene has it'
    PASSED_OVER = 'the comparison does not look at it'
    LOOSENED = 'the comparison allows for more'


class KnownDefect(NamedTuple):
    """One thing that libsdformat gets wrong."""

    subject: str
    fixed_in: str
    """Earliest release that is known to be without it; empty where there is none."""
    remedy: Remedy
    explanation: str


JOINT_SENSOR = KnownDefect(
    'sensor of a joint', '12.6', Remedy.PASSED_OVER,
    'its pose is kept as it is written, and cannot be resolved')
PROJECTOR = KnownDefect(
    'projector', '14.0', Remedy.PASSED_OVER,
    'the library has no class for it')
MERGED_PLACEMENT = KnownDefect(
    'merged model with a placement frame', '14.0', Remedy.LOOSENED,
    'the pose that follows from it is written with six digits')
URDF_ANGLES = KnownDefect(
    'angles in URDF near half turns and gimbal lock', '', Remedy.LOOSENED,
    'they are written with few digits; by chance, 3.14159 and -3.14159 are not one rotation')

KNOWN_DEFECTS = (
    JOINT_SENSOR,
    PROJECTOR,
    MERGED_PLACEMENT,
    URDF_ANGLES,
    KnownDefect(
        'fixed joint or its child link in URDF with one of "\'&< in its name', '',
        Remedy.NOT_DRAWN, 'it crashes'),
    KnownDefect(
        'number out of range in the <origin> of a URDF robot', '', Remedy.NOT_DRAWN,
        'an exception leaves the library'),
    KnownDefect(
        'tab between numbers in URDF', '', Remedy.NOT_DRAWN,
        'it separates nothing, though XML makes a blank of it'),
    KnownDefect(
        'version 1.12', '15.0', Remedy.NOT_DRAWN,
        'releases 13 and 14 refuse it, though its poses are those of 1.11'),
    KnownDefect(
        'quaternion of another length than one', '', Remedy.NOT_DRAWN,
        'it is not normalised, so that inverses, and with them placement frames, come out wrong'),
    KnownDefect(
        '__model__ or a::__model__ as parent or child of a joint', '12.4', Remedy.NOT_DRAWN,
        'it is refused as the name of something that does not exist'),
    KnownDefect(
        'nested model as parent of a joint', '13.0', Remedy.NOT_DRAWN,
        'it is refused as the name of nothing, though as a child it is taken'),
    KnownDefect(
        'many digits in the pose of a merged model', '14.0', Remedy.NOT_DRAWN,
        'it is written anew with six digits, so that only poses with few digits are drawn'),
    KnownDefect(
        '__model__ as parent or child of a joint in a merged model', '14.0', Remedy.NOT_DRAWN,
        'it is not rewritten'),
    KnownDefect(
        'joint in a world, and a model merged into a world', '14.0', Remedy.NOT_DRAWN,
        'both came with SDFormat 1.10, which the library does not know yet'),
    KnownDefect(
        'expressed_in that names nothing', '14.0', Remedy.NOT_DRAWN,
        'it is accepted'),
    KnownDefect(
        'bare & after a character reference in one value', '', Remedy.NOT_DRAWN,
        'another character of the file takes its place'),
    KnownDefect(
        'model and frame of one name in a world', '14.0', Remedy.NOT_DRAWN,
        'the frame is renamed, whatever the version of the file'),
    KnownDefect(
        "relative_to of only white space in a model file's own model", '14.0', Remedy.NOT_DRAWN,
        'it is taken for a name; everywhere else it means none'),
    KnownDefect(
        'siblings of different kinds with one name in a file before 1.7', '14.0', Remedy.NOT_DRAWN,
        'which of them is renamed depends on their kinds, and later on their order'),
    KnownDefect(
        'merge that is no boolean, in a world', '14.0', Remedy.NOT_DRAWN,
        'it is not looked at'),
    KnownDefect(
        'names true and false', '13.0', Remedy.NOT_DRAWN,
        'they become 1 and 0, but not in a longer reference such as a::true'),
    KnownDefect(
        'names with :: in files of version 1.7 and before', '', Remedy.NOT_DRAWN,
        'models are made of them by a rule that also takes names which only begin alike'),
    KnownDefect(
        'axis in a joint with :: in its name in files of version 1.4 and before', '',
        Remedy.NOT_DRAWN, 'it crashes where it makes models of such names'),
    KnownDefect(
        'static model without links as the first nested model of a model without links', '',
        Remedy.NOT_DRAWN,
        'the outer model then has no canonical link, though it has to have one'),
)
