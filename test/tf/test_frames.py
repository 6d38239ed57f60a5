# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Frames are added after others, and have transforms."""

import numpy as np
import pytest

from sdf_pose_bridge import Pose
from sdf_pose_bridge.tf.frames import Frame, Frames
from sdf_pose_bridge.tf.parents import NO_PARENT, ROOT_IS_PARENT


@pytest.fixture
def frames():
    """Return the frames a without a parent, b in the root, and c in b."""
    return Frames(
        ['a', 'b'], np.array([1, 2], np.int32), np.array([NO_PARENT, ROOT_IS_PARENT], np.int32),
        np.array([Pose(5), Pose(1)])).with_frames([Frame('c', 2, 1, Pose(1, 3))])


def test_frames_follow_others(frames):
    assert list(frames.ids) == ['a', 'b', 'c']
    assert frames.owners.tolist() == [1, 2, 2]
    assert frames.parents.tolist() == [NO_PARENT, ROOT_IS_PARENT, 1]
    assert frames.poses[:, :2].tolist() == [[5, 0], [1, 0], [1, 3]]


def test_no_frames_follow_others(frames):
    assert frames.with_frames([]) == frames


def test_transforms(frames):
    assert frames.transforms().tolist() == [list(Pose()), list(Pose(1)), list(Pose(0, 3))]
