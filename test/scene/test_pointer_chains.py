# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Chains and rings of pointers."""

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from sdf_pose_bridge.scene.pointer_chains import ends_from_pointers
from sdf_pose_bridge.scene.pointer_chains import rings_from_pointers

POINTERS = st.integers(1, 40).flatmap(
    lambda count: st.lists(st.integers(-1, count - 1), min_size=count, max_size=count))


def array(pointers):
    return np.array(pointers, dtype=np.int32)


def test_nothing():
    assert ends_from_pointers(array([])).tolist() == []
    assert rings_from_pointers(array([])) == []


@pytest.mark.parametrize('count', [1, 2, 3, 7, 8, 9, 1000])
def test_one_long_chain(count):
    pointers = array(range(-1, count - 1))
    assert ends_from_pointers(pointers).tolist() == [0] * count
    assert rings_from_pointers(pointers) == []


@pytest.mark.parametrize('count', [1, 2, 3, 4, 5, 8, 100])
def test_one_ring_and_what_leads_into_it(count):
    pointers = [*((i + 1) % count for i in range(count)), 0, count]
    ring, = rings_from_pointers(array(pointers))
    start = ring.index(0)
    assert [*ring[start:], *ring[:start]] == list(range(count))


@given(POINTERS)
def test_any_pointers(pointers):
    in_rings = set()
    ends = []
    for start in range(len(pointers)):
        node, passed = start, []
        while node >= 0 and node not in passed:
            passed.append(node)
            node = pointers[node]
        ends.append(passed[-1] if node < 0 else None)
        if node >= 0:
            in_rings.update(passed[passed.index(node):])
    rings = rings_from_pointers(array(pointers))
    assert sorted(node for ring in rings for node in ring) == sorted(in_rings)
    assert all([pointers[node] for node in ring] == ring[1:] + ring[:1] for ring in rings)
    found = ends_from_pointers(array(pointers)).tolist()
    assert all(
        a in in_rings if b is None else a == b for a, b in zip(found, ends, strict=True))
