# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Measure one load in a process of its own: ``python -m growth.measurement FILE``.

Prints processor time in seconds, by how many bytes the peak of the memory was raised, and how the
load has ended. What the node makes of a scene before it publishes it belongs to the load.
"""

import resource
import sys
import time

from sdf_pose_bridge import load, SdfError
from sdf_pose_bridge.ros.cdr import StampedRecords
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions


def outcome_of_load(path):
    """Load a file as the node does; return the codes of its errors, or its size."""
    try:
        scene = load(path)
        tree = tf_tree_from_scene(scene, TfOptions(use_joint_states=True))
        if tree.moving is not None:
            JointPositions(scene, tree.moving.motion)
        fixed = tree.fixed_indices
        StampedRecords(tree.ids_of_transforms(fixed), tree.transforms[fixed]).tf_message()
        PoseLookup(scene, tree)
    except SdfError as error:
        return ' '.join(dict.fromkeys(each.code for each in error.errors))
    return f'{len(scene.names)} elements'


def peak_bytes():
    """Return the peak of the memory of this process."""
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


if __name__ == '__main__':
    memory, begin = peak_bytes(), time.process_time()
    outcome = outcome_of_load(sys.argv[1])
    print(time.process_time() - begin, peak_bytes() - memory, outcome)
