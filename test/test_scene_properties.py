# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Properties of all scenes: composition of poses, and changes that move nothing."""

from matrices import assert_close, assert_same_pose, matrix_from_degrees, matrix_from_pose
import numpy as np
import pytest
from random_scenes import random_scenes
from sdf_texts import names_of

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given
from hypothesis import strategies as st

from sdf_pose_bridge import load_text
from sdf_pose_bridge.tf.comparison import Change, differences_of_scenes

ORDERS = st.randoms(use_true_random=False).map(
    lambda random: lambda item, keys={}: keys.setdefault(id(item), random.random()))


def assert_same_scene(first, second, tolerance=1e-9):
    """Check that two scenes have the same names and poses, in whatever order."""
    # The first link of a model is the parent of others in TF, and the first joint moves a link.
    assert [each for each in differences_of_scenes(first, second, tolerance=tolerance)
            if each.change in (Change.ADDED, Change.REMOVED, Change.MOVED)] == []


@given(random_scenes())
def test_poses_are_those_calculated_independently(drawn):
    scene = load_text(drawn.text())
    matrices = drawn.matrices()
    assert names_of(scene) == list(dict.fromkeys(names_of(scene)))
    assert set(names_of(scene)) == set(matrices)
    for name, matrix in matrices.items():
        assert_same_pose(scene.pose(name), matrix, name=name)


@given(random_scenes(), st.data())
def test_poses_can_be_composed(drawn, data):
    scene = load_text(drawn.text())
    names = st.sampled_from(names_of(scene))
    first, second, third = data.draw(names), data.draw(names), data.draw(names)
    in_second = matrix_from_pose(scene.pose(first, second))
    assert_close(
        matrix_from_pose(scene.pose(second)) @ in_second, matrix_from_pose(scene.pose(first)))
    assert_same_pose(
        scene.pose(first, third), matrix_from_pose(scene.pose(second, third)) @ in_second)


@given(random_scenes(), ORDERS)
def test_order_of_siblings_moves_nothing(drawn, order):
    assert_same_scene(load_text(drawn.text()), load_text(drawn.text(order)))


@given(random_scenes(is_world=False))
def test_model_in_a_world_is_only_placed(drawn):
    place = (1.5, -2.0, 0.25, 30, -45, 60)
    alone = load_text(drawn.text())
    placed = load_text(drawn.text(wrapped_at=place))
    matrix = matrix_from_degrees(*place)
    for name in names_of(alone):
        assert_same_pose(placed.pose(name), matrix @ matrix_from_pose(alone.pose(name)), name=name)
        assert_same_pose(
            placed.pose(name, drawn.root.children[0].name),
            matrix_from_pose(alone.pose(name, drawn.root.children[0].name)), name=name)


@given(random_scenes(), st.data())
def test_pose_that_is_written_relative_to_another_frame_moves_nothing(drawn, data):
    item = data.draw(st.sampled_from([item for item in drawn.items if item.parent.kind]))
    earlier = drawn.items[:drawn.items.index(item)]
    reference = data.draw(st.sampled_from([
        other for other in earlier
        if item.scope in other.chain() and other.kind in {'model', 'link', 'frame', 'joint'}]))
    item.placement = None
    before = load_text(drawn.text())
    relative = before.pose(item.scoped_name, reference.scoped_name)
    item.pose = tuple(relative)
    item.reference = reference
    assert_same_scene(before, load_text(drawn.text()))


@given(random_scenes())
def test_loading_twice_gives_the_same_bits(drawn):
    first, second = load_text(drawn.text()), load_text(drawn.text())
    assert first.names == second.names
    np.testing.assert_array_equal(first.poses, second.poses)
