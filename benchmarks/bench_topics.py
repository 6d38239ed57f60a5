# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What a pose topic costs the node, compared with one of rclpy, each in its own process."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
import subprocess
import sys

from benchmarks.harness import AtMostTimes, benchmark, Function, Held, Took

ROOT = Path(__file__).resolve().parents[1]
TOPICS = 1000

PROGRAM = """
import sys
import time

from benchmarks.bench_publication import latched_publisher
from benchmarks.bench_publication import node
from benchmarks.bench_publication import publishers_of_poses
from benchmarks.bench_publication import scene_of
from geometry_msgs.msg import PoseStamped
from sdf_pose_bridge.ros.publishing.published_frames import PublishedFrames
from sdf_pose_bridge.ros.publishing.publishers import Publishers
from sdf_pose_bridge.ros.publishing.topic_names import pose_topics_from_patterns
from sdf_pose_bridge.tf.tree import tf_tree_from_scene

def memory_kb():
    with open('/proc/self/status') as status:
        return next(int(line.split()[1]) for line in status if line.startswith('VmRSS:'))

def publish_as_the_bridge(ros, tree, patterns=('?*',)):
    topics = pose_topics_from_patterns(tree.frame_ids, patterns, '/benchmark').names
    frames = PublishedFrames(bridge, tree, None, topics)
    frames.open_topics()
    frames.publish_topics()

publish = publish_as_the_bridge if sys.argv[1] == 'bridge' else publishers_of_poses
tree = tf_tree_from_scene(scene_of(int(sys.argv[2]) // 10))
assert len(tree.frame_ids) == int(sys.argv[2])
with node() as ros:
    bridge = Publishers(ros)
    # What is needed only once exists after this.
    publish_as_the_bridge(ros, tree, tree.frame_ids[:1])
    latched_publisher(ros, PoseStamped, '/first', 1).publish(PoseStamped())
    held = memory_kb()
    begin = time.perf_counter()
    published = publish(ros, tree)
    print(time.perf_counter() - begin, 1024 * (memory_kb() - held))
"""


def cost_of_topic(whose: str) -> tuple[float, int]:
    """Return the seconds and bytes that one topic takes in a new process."""
    printed = subprocess.run(
        [sys.executable, '-c', PROGRAM, whose, str(TOPICS)], cwd=ROOT, check=True,
        capture_output=True, text=True).stdout
    seconds, bytes_ = printed.split()
    return float(seconds) / TOPICS, int(bytes_) // TOPICS


@benchmark(
    f'topic of poses made and sent, each of {TOPICS:,}', counterpart="rclpy's publisher",
    goal=AtMostTimes(1.0))
def time_of_topic() -> Iterator[tuple[Function, Function | None]]:
    yield lambda: Took(cost_of_topic('bridge')[0]), lambda: Took(cost_of_topic('rclpy')[0])


@benchmark(
    f'topic of poses held, each of {TOPICS:,}', counterpart="rclpy's publisher",
    goal=AtMostTimes(1.0, 'memory'))
def memory_of_topic() -> Iterator[tuple[Function, Function | None]]:
    yield lambda: Held(cost_of_topic('bridge')[1]), lambda: Held(cost_of_topic('rclpy')[1])
