# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Measure one load in a process of its own: ``python -m growth.measurement FILE``.

Prints processor time in seconds, the peak of memory in bytes, by how much the load has raised it,
the longest time in seconds that another thread had to wait, and how the load has ended. What the
node makes of a scene before it publishes it belongs to the load.
"""

import resource
import sys
import threading
import time

TICK_S = 0.01


class Watchdog(threading.Thread):
    """A thread that wants to run every 10 ms, and notes the longest time in which it could not."""

    def __init__(self) -> None:
        super().__init__(daemon=True)
        self.longest_s = 0.0

    def run(self) -> None:
        """Note how much processor time the process has used between two ticks."""
        # Other processes make ticks late, but use no processor time of this one.
        before = time.process_time()
        while True:
            time.sleep(TICK_S)
            now = time.process_time()
            self.longest_s = max(self.longest_s, now - before)
            before = now


def peak_bytes() -> int:
    """Return the peak of the memory of this process."""
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def outcome_of_load(path: str) -> str:
    """Load a file as the node does; return the codes of its errors, or its size."""
    from sdf_pose_bridge import load, SdfError
    from sdf_pose_bridge.ros.cdr import tf_message
    from sdf_pose_bridge.tf.joint_positions import JointPositions
    from sdf_pose_bridge.tf.lookup import PoseLookup
    from sdf_pose_bridge.tf.tree import FrameNames, tf_tree_from_scene, TfOptions
    try:
        scene = load(path)
        tree = tf_tree_from_scene(scene, TfOptions(use_joint_states=True))
        if tree.moving is not None:
            JointPositions(scene, tree.moving.dofs, FrameNames.AUTO, '')
        fixed = tree.fixed_indices
        tf_message(tree.ids_of_transforms(fixed), tree.transforms[fixed])
        PoseLookup(scene, tree)
    except SdfError as error:
        return ' '.join(dict.fromkeys(each.code for each in error.errors))
    return f'{len(scene.names)} elements'


def main() -> None:
    """Measure the load of the file that the argument names."""
    (path,) = sys.argv[1:]
    outcome_of_load('/dev/null')  # imports everything
    watchdog = Watchdog()
    watchdog.start()
    memory = peak_bytes()
    begin = time.process_time()
    outcome = outcome_of_load(path)
    seconds = time.process_time() - begin
    print(seconds, peak_bytes(), peak_bytes() - memory, watchdog.longest_s, outcome)


if __name__ == '__main__':
    main()
