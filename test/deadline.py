# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The deadline of all tests that wait for an event."""

import time

DEADLINE_S = 600.0
"""Longest wait for an event; a test that passes waits for a small part of it on any machine."""


def wait_until(is_true, step=lambda: time.sleep(0.01), what='it'):
    """
    Repeat a step until a condition is true.

    :param what: what did not happen, or a function that returns it, for the message of the
        failure.
    """
    ends_at = time.monotonic() + DEADLINE_S
    while not is_true():
        assert time.monotonic() < ends_at, (
            f'waited in vain for {what() if callable(what) else what}')
        step()


def spin_until(executor, is_true, what='it'):
    """Run callbacks of an executor until a condition is true; as :func:`wait_until`."""
    wait_until(is_true, lambda: executor.spin_once(timeout_sec=0.01), what)
