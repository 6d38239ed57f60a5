# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Chains of pointers: their ends, their cycles, and the poses along them."""

import numpy as np
import pytest

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given
from hypothesis import strategies as st

from sdf_pose_bridge.geometry.chains import (
    cycles_from_pointers,
    ends_from_pointers,
    poses_along_chains,
)
from sdf_pose_bridge.geometry.poses import Pose

POINTERS = st.integers(1, 40).flatmap(
    lambda count: st.lists(st.integers(-1, count - 1), min_size=count, max_size=count))


def array(pointers):
    return np.array(pointers, dtype=np.int32)


def test_no_pointers():
    assert ends_from_pointers(array([])).tolist() == []
    assert cycles_from_pointers(array([])) == []


@pytest.mark.parametrize('count', [1, 2, 3, 7, 8, 9, 1000])
def test_long_chain(count):
    pointers = array(range(-1, count - 1))
    assert ends_from_pointers(pointers).tolist() == [0] * count
    assert cycles_from_pointers(pointers) == []


def followed(pointers, start):
    """Return the nodes from one to the end of its path, and those of the cycle at its end."""
    node, visited = start, []
    while node >= 0 and node not in visited:
        visited.append(node)
        node = pointers[node]
    return visited, visited[visited.index(node):] if node >= 0 else []


@given(POINTERS)
def test_ends_of_any_pointers(pointers):
    ends = ends_from_pointers(array(pointers)).tolist()
    for start, end in enumerate(ends):
        visited, cycle = followed(pointers, start)
        assert end in cycle if cycle else end == visited[-1]


@given(POINTERS)
def test_cycles_of_any_pointers(pointers):
    expected = {
        node for start in range(len(pointers)) for node in followed(pointers, start)[1]}
    cycles = cycles_from_pointers(array(pointers))
    assert sorted(node for cycle in cycles for node in cycle) == sorted(expected)
    assert all([pointers[node] for node in cycle] == cycle[1:] + cycle[:1] for cycle in cycles)


@pytest.mark.parametrize('count', [1, 2, 3, 7, 8, 9, 1000])
def test_poses_are_in_the_end_of_their_chain(count):
    edges = np.tile(Pose(x=1.0), (count, 1))
    poses = poses_along_chains(edges, array(range(-1, count - 1)), np.arange(count))
    assert poses[1:, 0].tolist() == list(range(1, count))
    assert (edges[:, 0] == 1.0).all()
