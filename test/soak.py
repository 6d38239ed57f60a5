# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Rewrite the file of a bridge ten times a second while twelve other processes listen and call.

Every tenth file is broken. The exit code is 0 if every call was answered, if all listeners have
the last file in the end, and if memory, threads and descriptors of the bridge have not grown.
"""

from __future__ import annotations

import argparse
import contextlib
import math
import multiprocessing
import os
from pathlib import Path
import sys
import tempfile
import time

from bridge_process import BridgeProcess
from changes import BRIDGE, last_x, listen_to_tf, replace, usage_of, world
from deadline import DEADLINE_S
from geometry_msgs.msg import PoseStamped, TransformStamped
from listener import latched, Listener
import numpy as np
from ros_domain import claimed_domain

from sdf_pose_bridge_interfaces.srv import LookupPose

CLIENTS = 6
"""How many processes listen, and how many call."""

PERIOD_S = 0.1
SAMPLE_PERIOD_S = 5.0
MOST_GROWTH_KB_PER_HOUR = 2048


def listen(domain, last, results):
    """Listen to all topics until what the last file says has arrived on each of them."""
    listener = Listener(domain)
    seen = {}
    listen_to_tf(listener)
    listener.node.create_subscription(
        PoseStamped, f'{BRIDGE}/poses/crate/body',
        lambda message: seen.update(pose=message.pose.position.x), latched(1))
    listener.node.create_subscription(
        TransformStamped, f'{BRIDGE}/transforms',
        lambda message: seen.update({message.child_frame_id: message.transform.translation.x}),
        latched(10))
    count = 0
    while not last.value:
        listener.spin_once()
        count += len(listener.tf_messages)
        del listener.tf_messages[:-1]
    expected = last.value
    with contextlib.suppress(AssertionError):
        listener.wait(lambda: {
            last_x(listener), seen.get('pose'), seen.get('crate/body')} == {expected}, str)
    results.put(('listener', count, {
        last_x(listener), seen.get('pose'), seen.get('crate/body')} == {expected}))
    listener.end()


def call(domain, last, results):
    """Look a pose up again and again, until the last file is written and served."""
    listener = Listener(domain)
    request = LookupPose.Request(frame='crate::body')
    count, x, ends_at = 0, None, math.inf
    with contextlib.suppress(AssertionError):
        while not last.value or (x != last.value and time.monotonic() < ends_at):
            x = listener.call(LookupPose, f'{BRIDGE}/lookup_pose', request).pose.pose.position.x
            count += 1
            if last.value:
                ends_at = min(ends_at, time.monotonic() + DEADLINE_S)
            time.sleep(PERIOD_S)
    results.put(('caller', count, x == last.value))
    listener.end()


def rewrite(path, seconds, pid):
    """Rewrite the file, and return the usage of a process: rows of time in s, kB and counts."""
    begin = time.monotonic()
    rows, number = [], 0
    while (now := time.monotonic() - begin) < seconds:
        number += 1
        replace(path, world(number) if number % 10 else '<sdf')
        if now >= len(rows) * SAMPLE_PERIOD_S:
            rows.append((now, *usage_of(pid)))
        time.sleep(max(0.0, begin + number * PERIOD_S - time.monotonic()))
    replace(path, world(number + 1))
    return np.array(rows), number + 1


def soak(folder, minutes, domain):
    """Do all of it, print what was measured, and return whether everything is as it should be."""
    path = Path(folder, 'cell.sdf')
    path.write_text(world(0))
    spawning = multiprocessing.get_context('spawn')
    last, results = spawning.Value('d', 0.0), spawning.Queue()
    bridge = BridgeProcess(sdf_file=path).wait_until_started()
    clients = [
        spawning.Process(target=target, args=(domain, last, results))
        for target in (listen, call) for _ in range(CLIENTS)]
    for client in clients:
        client.start()
    rows, number = rewrite(path, 60.0 * minutes, bridge.pid)
    last.value = number
    found = [results.get(timeout=DEADLINE_S) for _ in clients]
    for client in clients:
        client.join()
    bridge.end()
    # The first part is not counted: caches fill and clients come.
    rows = rows[len(rows) // 5:]
    hours = rows[:, 0] / 3600.0
    slopes = [np.polyfit(hours, column, 1)[0] for column in rows[:, 1:].T]
    print(f'{number} files in {minutes:g} minutes, '
          f'{sum("publishing" in line for line in bridge.lines)} of them published')
    for role in ('listener', 'caller'):
        mine = [each for each in found if each[0] == role]
        print(f'{len(mine)} {role}s, {sum(each[1] for each in mine)} messages or calls, '
              f'{sum(each[2] for each in mine)} have the last file')
    for what, column, slope in zip(
            ('memory in kB', 'threads', 'descriptors'), rows[:, 1:].T, slopes, strict=True):
        print(f'{what}: {column[0]:.0f} at first, {column[-1]:.0f} at last, from '
              f'{column.min():.0f} to {column.max():.0f}, {slope:+.1f} per hour')
    internal = [line for line in bridge.lines if 'internal error' in line]
    print(f'{len(internal)} internal errors in the log')
    return (all(each[2] for each in found) and not internal
            and slopes[0] < MOST_GROWTH_KB_PER_HOUR
            and (rows[-1, 2:] <= rows[0, 2:] + 1).all())


def main():
    """Run it for some minutes."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--minutes', type=float, default=30.0)
    options = parser.parse_args()
    with claimed_domain() as domain, tempfile.TemporaryDirectory() as folder:
        os.environ.update(
            ROS_DOMAIN_ID=str(domain), ROS_AUTOMATIC_DISCOVERY_RANGE='LOCALHOST',
            ROS_LOG_DIR=folder)
        return 0 if soak(folder, options.minutes, domain) else 1


if __name__ == '__main__':
    sys.exit(main())
