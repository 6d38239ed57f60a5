# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Follow chains in a graph in which every node points to one other or to none."""

from __future__ import annotations

import numpy as np

from sdf_pose_bridge.sdformat.elements import Indices


def ends_from_pointers(pointers: Indices) -> Indices:
    """
    Follow every node to the end of its chain.

    :param pointers: the node that each node points to; -1 for none.
    :return: the end of each node's chain, which points to none. Of a node that leads into a ring,
        any node of that ring.
    """
    ends = np.where(pointers < 0, np.arange(len(pointers), dtype=np.int32), pointers)
    # Each round doubles the length of what has been followed.
    for _ in range(len(pointers).bit_length()):
        further = ends[ends]
        if np.array_equal(further, ends):
            break
        ends = further
    return ends


def rings_from_pointers(pointers: Indices) -> list[list[int]]:
    """
    Find the rings.

    :param pointers: the node that each node points to; -1 for none.
    :return: the nodes of each ring, each pointing to the next.
    """
    ends = ends_from_pointers(pointers)
    nodes = ends[pointers[ends] >= 0]
    rings: list[list[int]] = []
    found: set[int] = set()
    for node in nodes.tolist():
        ring: list[int] = []
        while node not in found:
            found.add(node)
            ring.append(node)
            node = int(pointers[node])
        if ring:
            rings.append(ring)
    return rings
