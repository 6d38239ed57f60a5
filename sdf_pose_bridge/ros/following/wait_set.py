# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Wait for messages in a thread, without the executor of the node.

An executor takes three times as long for a message. ``rclpy.wait_for_message`` waits in the same
way and uses the same private names. rclpy 7 to 10 have all of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack, suppress
import math

from rclpy.callback_groups import CallbackGroup
from rclpy.context import Context
from rclpy.exceptions import InvalidHandle
from rclpy.guard_condition import GuardCondition
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.subscription import Subscription

from sdf_pose_bridge.ros.cdr import NANOSECONDS

_FOREVER = -1


class NoExecutor(CallbackGroup):
    """The group of subscriptions for which no executor waits."""

    def can_execute(self, _entity: object) -> bool:
        """Return that no executor has to wait."""
        return False


class WaitSet:
    """
    Waits for messages; for one thread, and others can wake it.

    :param context: the context of the subscriptions.
    """

    def __init__(self, context: Context) -> None:
        self._context = context
        self._guard_condition = GuardCondition(None, None, context=context)
        self._subscriptions: Sequence[Subscription] | None = None
        self._held = ExitStack()

    def wake(self) -> None:
        """End the current call of :meth:`wait`, or the next one, unless it is closed."""
        with suppress(InvalidHandle):
            self._guard_condition.trigger()

    def wait(self, subscriptions: Sequence[Subscription], timeout_s: float) -> list[int]:
        """
        Wait for a message, or a call of :meth:`wake`.

        :param subscriptions: the subscriptions, which are in the group :class:`NoExecutor`.
        :param timeout_s: the longest time in s; infinity for any time.
        :return: the indices of the subscriptions that have a message.
        :raises rclpy.exceptions.InvalidHandle: if one of them has been destroyed.
        """
        if subscriptions != self._subscriptions:
            self._prepare(subscriptions)
        wait_set = self._wait_set
        wait_set.clear_entities()
        wait_set.add_guard_condition(self._guard_condition.handle)
        for subscription in subscriptions:
            wait_set.add_subscription(subscription.handle)
        wait_set.wait(_FOREVER if math.isinf(timeout_s) else int(timeout_s * NANOSECONDS))
        ready = set(wait_set.get_ready_entities('subscription'))
        return [index for index, each in enumerate(subscriptions) if each.handle.pointer in ready]

    def close(self) -> None:
        """Destroy it. Subscriptions that were destroyed before are released."""
        self._held.close()
        self._guard_condition.destroy()

    def _prepare(self, subscriptions: Sequence[Subscription]) -> None:
        self._subscriptions = None
        self._held.close()
        with ExitStack() as stack:
            # A handle that is held is not released, even if its owner is destroyed.
            for handle in (
                self._context.handle, self._guard_condition.handle,
                *(each.handle for each in subscriptions),
            ):
                stack.enter_context(handle)
            self._wait_set = rclpy_implementation.WaitSet(
                len(subscriptions), 1, 0, 0, 0, 0, self._context.handle)
            self._held = stack.pop_all()
        self._subscriptions = subscriptions


def take_message(subscription: Subscription) -> tuple[bytes, int | None] | None:
    """
    Take a message that a subscription for serialized messages has.

    :return: the message, and its number, which goes up for each publisher, or None if the
        middleware does not number messages; None if no message waits.
    """
    with subscription.handle:
        taken = subscription.handle.take_message(subscription.msg_type, True)
    return None if taken is None else (taken[0], taken[1]['publication_sequence_number'])
