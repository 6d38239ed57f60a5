# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Make TF trees of short SDF texts, and check that they are trees."""

from matrices import matrix_from_pose
import numpy as np
import pytest

import sdf_pose_bridge
from sdf_pose_bridge import SdfError
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions


def model(name, children, pose=''):
    return f'<model name="{name}">{pose}{children}</model>'


def tree_of(text, **options):
    tree = tf_tree_from_scene(sdf_pose_bridge.load_text(text), TfOptions(**options))
    assert_is_tree(tree)
    return tree


def parents_of(text, **options):
    tree = tree_of(text, **options)
    return dict(zip(tree.frame_ids, tree.parent_ids, strict=True))


def pose_of(tree, frame_id):
    return tree.poses[tree.frame_ids.index(frame_id)].tolist()


def tree_errors_of(text, **options):
    with pytest.raises(SdfError) as caught:
        tf_tree_from_scene(sdf_pose_bridge.load_text(text, 'file.sdf'), TfOptions(**options))
    return caught.value.errors


def only_tree_error(text, **options):
    errors = tree_errors_of(text, **options)
    assert len(errors) == 1, [str(error) for error in errors]
    return errors[0]


def assert_is_tree(tree):
    """Check that TF accepts the frames, and that composing the transforms gives their poses."""
    ids = tree.frame_ids
    indices = {frame_id: index for index, frame_id in enumerate(ids)}
    assert len(indices) == len(ids) == len(tree.parent_ids) == len(tree.poses)
    assert tree.root_frame not in indices
    assert all(frame_id and not frame_id.startswith('/') for frame_id in ids)
    assert set(tree.parent_ids) <= {*ids, tree.root_frame, ''}
    assert np.isfinite(tree.transforms).all()
    np.testing.assert_allclose(
        np.linalg.norm(tree.transforms[:, 3:], axis=1), 1.0, rtol=0.0, atol=1e-12)
    assert (tree.transforms[:, 6] >= 0.0).all()
    poses = [matrix_from_pose(pose) for pose in tree.poses.tolist()]
    transforms = [matrix_from_pose(pose) for pose in tree.transforms.tolist()]
    for index in range(len(ids)):
        matrix = np.eye(4)
        last = index
        for _ in ids:
            matrix = transforms[last] @ matrix
            parent = tree.parent_ids[last]
            if parent not in indices:
                break
            last = indices[parent]
        else:
            pytest.fail(f'"{ids[index]}" is its own ancestor')
        start = poses[last] if parent == '' else np.eye(4)
        if parent == '':
            np.testing.assert_array_equal(transforms[last], np.eye(4))
        np.testing.assert_allclose(start @ matrix, poses[index], rtol=0.0, atol=1e-9)
