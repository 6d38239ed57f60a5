# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Kinds of element that have a pose, and how SDFormat spells their names."""

from __future__ import annotations

import enum

SEPARATOR = '::'
"""Stands between the names of a scoped name: ``robot::arm::hand``."""

WORLD_FRAME = 'world'
"""The inertial frame of a world, as references in that world spell it."""

ROOT_FRAME = '__root__'
"""The implicit root outside the model of a model file; no file may write it."""

MODEL_FRAME = '__model__'
"""A model's own frame, as references inside that model spell it."""


class Kind(enum.IntEnum):
    """Kind of an element that has a pose."""

    ROOT = 0
    """What the poses of a model file are reported in; stands in no file."""
    WORLD = 1
    MODEL = 2
    LINK = 3
    JOINT = 4
    FRAME = 5
    VISUAL = 6
    COLLISION = 7
    SENSOR = 8
    LIGHT = 9
    INERTIAL = 10
    PARTICLE_EMITTER = 11
    PROJECTOR = 12
    ACTOR = 13

    # An Enum's own hash is a function in Python, and kinds are keys wherever elements are read.
    __hash__ = int.__hash__

    @property
    def label(self) -> str:
        """Name of the kind as SDFormat spells the element: ``particle_emitter``."""
        return self.name.lower()


FRAME_KINDS = frozenset({Kind.MODEL, Kind.LINK, Kind.JOINT, Kind.FRAME})
"""Kinds that others may refer to; they share one name space in a scope."""


def is_reserved(name: str) -> bool:
    """
    Tell whether SDFormat keeps a name for itself.

    :param name: an element's own name, without its scope.
    :return: true for ``world`` and for four or more characters between double underscores.
    """
    return name == WORLD_FRAME or (
        len(name) >= 4 and name.startswith('__') and name.endswith('__'))


def scoped_name(scope: str, name: str) -> str:
    """
    Return the absolute name of something in a scope.

    :param scope: absolute name of the scope; empty for a world or the implicit root.
    :param name: a name or a reference in that scope.
    :return: the two joined by ``::``.
    """
    return f'{scope}{SEPARATOR}{name}' if scope else name
