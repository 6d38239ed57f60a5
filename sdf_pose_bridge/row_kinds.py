# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Which elements may carry a pose, and which of them may hold which."""

from __future__ import annotations

from sdf_pose_bridge.names import Kind

INCLUDE = 253
"""Stands for a kind that only rows have, until what is included is read."""
OUTSIDE = 255
"""Stands for the kind of the document itself."""
NO_KIND = 254
"""Stands for the kind of what has no row."""
KINDS_OF_TAGS = {kind.label: int(kind) for kind in Kind if kind is not Kind.ROOT} | {
    'include': INCLUDE}
CHILDREN = {
    OUTSIDE: (Kind.WORLD, Kind.MODEL, Kind.LIGHT, Kind.ACTOR, INCLUDE),
    Kind.WORLD: (Kind.MODEL, Kind.FRAME, Kind.JOINT, Kind.LIGHT, Kind.ACTOR, INCLUDE),
    Kind.MODEL: (Kind.LINK, Kind.JOINT, Kind.FRAME, Kind.MODEL, INCLUDE),
    Kind.LINK: (
        Kind.VISUAL, Kind.COLLISION, Kind.SENSOR, Kind.LIGHT, Kind.INERTIAL,
        Kind.PARTICLE_EMITTER, Kind.PROJECTOR),
    Kind.JOINT: (Kind.SENSOR,),
}
"""What each kind may hold."""
ROW_TAGS = tuple(KINDS_OF_TAGS)
"""The tags of all elements that may have rows."""
TOP_TAGS = tuple(tag for tag, kind in KINDS_OF_TAGS.items() if kind in CHILDREN[OUTSIDE])
"""Those of them that may stand at the top of a document."""
