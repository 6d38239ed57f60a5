# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""How long a caller waits at most while others send as much as they can, or ask for much."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
import contextlib
from pathlib import Path
import subprocess
import sys
import tempfile
import time
from typing import Any

from benchmarks.bench_models import world_text
from benchmarks.harness import benchmark, Function, TimesAsFast, Took
from benchmarks.processes import RunningBridge

LONGEST_WAIT_S = 0.5
"""As docs/security.md says."""

WINDOW_S = 5.0
MODELS = 500

SENDING = """
import sys
import time

import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import serialize_message
from tf2_msgs.msg import TFMessage

topic, prefix = sys.argv[1:3]
rate_hz, children, frame_ids = map(int, sys.argv[3:])
message = TFMessage()
for number in range(max(children, frame_ids)):
    transform = TransformStamped(child_frame_id=f'{prefix}{number % children}')
    transform.header.frame_id = f'f{number}' if frame_ids else 'wall/l'
    transform.transform.translation.x = float(number)
    message.transforms.append(transform)
rclpy.init()
node = rclpy.create_node('sending')
quality = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
publisher = node.create_publisher(TFMessage, topic, quality)
data, sec = serialize_message(message), 0
print('ready', flush=True)
while True:
    publisher.publish(data)
    time.sleep(1.0 / rate_hz)
    if not frame_ids:
        sec += 1
        for transform in message.transforms:
            transform.header.stamp.sec = sec
        data = serialize_message(message)
"""
"""Sends a message again and again: topic, beginning of child frame ids, rate, number of these and
of frame ids."""


@contextlib.contextmanager
def waits(
    service_type: Any, name: str, request: Any, parameters: Sequence[str],
    sender: Sequence[object],
) -> Iterator[tuple[Function, Function | None]]:
    """Give functions for the longest of many calls beside a sender, and without it."""
    with contextlib.ExitStack() as stack:
        file = Path(stack.enter_context(tempfile.TemporaryDirectory()), 'world.sdf')
        wall = '<model name="wall"><static>true</static><link name="l"/></model></world>'
        file.write_text(world_text(MODELS).replace('</world>', wall), encoding='utf-8')
        bridge = RunningBridge(stack, file, *parameters)
        call = bridge.client.caller(service_type, f'/sdf_pose_bridge/{name}', request)

        def longest() -> Took:
            took = [0.0]
            ends_at = time.perf_counter() + WINDOW_S
            while time.perf_counter() < ends_at:
                begin = time.perf_counter()
                call()
                took.append(time.perf_counter() - begin)
                time.sleep(0.01)
            return Took(max(took))

        def ours() -> Took:
            with contextlib.ExitStack() as others:
                process = bridge.start(
                    others, sys.executable, '-c', SENDING, *sender, stdout=subprocess.PIPE,
                    stderr=subprocess.DEVNULL)
                assert process.stdout is not None
                process.stdout.readline()
                return longest()
        yield ours, longest


@benchmark(
    'longest ~/set_parameters beside 20 messages of 1 MB a second on /tf_static',
    counterpart='without them', goal=TimesAsFast(longest_s=LONGEST_WAIT_S))
def setting_beside_a_flood() -> Iterator[tuple[Function, Function | None]]:
    from rcl_interfaces.srv import SetParameters
    from rclpy.parameter import Parameter
    request = SetParameters.Request(
        parameters=[Parameter('publish_rate', value=0.0).to_parameter_msg()])
    sender = '/tf_static', 'x', 20, 9000, 9000
    with waits(SetParameters, 'set_parameters', request, (), sender) as pair:
        yield pair


def lookup_request() -> object:
    from sdf_pose_bridge_interfaces.srv import LookupPose
    return LookupPose.Request(frame='wall::l')


@benchmark(
    'longest ~/lookup_pose beside messages with 9,000 frame ids, for 1,000 patterns',
    counterpart='without them', goal=TimesAsFast(longest_s=LONGEST_WAIT_S))
def lookup_beside_frame_ids() -> Iterator[tuple[Function, Function | None]]:
    from sdf_pose_bridge_interfaces.srv import LookupPose
    patterns = ','.join(f"'robot{number}/*/odom'" for number in range(1000))
    with waits(
            LookupPose, 'lookup_pose', lookup_request(),
            ["model_pose_topics:=['/poses']", f'model_pose_frames:=[{patterns}]'],
            ('/poses', 'm', 2, MODELS, 9000)) as pair:
        yield pair


@benchmark(
    f'longest ~/lookup_pose beside poses of {MODELS} models in a frame of the tree',
    counterpart='without them', goal=TimesAsFast(longest_s=LONGEST_WAIT_S))
def lookup_beside_poses() -> Iterator[tuple[Function, Function | None]]:
    from sdf_pose_bridge_interfaces.srv import LookupPose
    with waits(
            LookupPose, 'lookup_pose', lookup_request(), ["model_pose_topics:=['/poses']"],
            ('/poses', 'm', 5, MODELS, 0)) as pair:
        yield pair
