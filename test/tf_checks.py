# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Make TF trees of short SDF texts, and check that they are trees."""

from matrices import assert_close, matrix_from_pose
import numpy as np
import pytest

from sdf_pose_bridge import load_text, SdfError
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions


def model(name, children, pose=''):
    return f'<model name="{name}">{pose}{children}</model>'


def tree_of(text, **options):
    tree = tf_tree_from_scene(load_text(text), TfOptions(**options))
    assert_is_tree(tree)
    return tree


def parents_of(text, **options):
    tree = tree_of(text, **options)
    return dict(zip(tree.frame_ids, tree.parent_ids, strict=True))


def pose_of(tree, frame_id):
    return tree.poses[tree.frame_ids.index(frame_id)].tolist()


def tree_errors_of(text, **options):
    with pytest.raises(SdfError) as caught:
        tf_tree_from_scene(load_text(text, 'file.sdf'), TfOptions(**options))
    assert caught.value.warnings == ()
    return caught.value.errors


def only_tree_error(text, **options):
    errors = tree_errors_of(text, **options)
    assert len(errors) == 1, [str(error) for error in errors]
    return errors[0]


def assert_is_tree(tree):
    """Check that TF accepts the frames, and that composing the transforms gives their poses."""
    ids = tree.frame_ids
    assert len({*ids, tree.root_frame}) - 1 == len(ids) == len(tree.poses)
    assert all(frame_id and not frame_id.startswith('/') for frame_id in ids)
    assert set(tree.parent_ids) <= {*ids, tree.root_frame, ''}
    assert np.isfinite(tree.transforms).all()
    assert_close(np.linalg.norm(tree.transforms[:, 3:], axis=1), 1.0, 1e-12)
    assert (tree.poses[:, 6] >= 0.0).all()
    assert (tree.transforms[:, 6] >= 0.0).all()
    above = dict(zip(ids, tree.parent_ids, strict=True))
    matrices = dict(zip(ids, map(matrix_from_pose, tree.poses.tolist()), strict=True))
    matrices[tree.root_frame] = np.eye(4)
    for frame_id, transform in zip(ids, tree.transforms.tolist(), strict=True):
        if above[frame_id]:
            parent = matrices[above[frame_id]]
            assert_close(parent @ matrix_from_pose(transform), matrices[frame_id])
        else:
            np.testing.assert_array_equal(matrix_from_pose(transform), np.eye(4))
        last = frame_id
        for _ in ids:
            last = above.get(last, '')
        assert last not in above, f'"{frame_id}" is its own ancestor'
