# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Parameters that override the quality of service of topics, as in nodes of rclcpp and rclpy.

Their names are ``qos_overrides.<topic>.<publisher or subscription>.<policy>``.
"""

from __future__ import annotations

from collections.abc import Mapping

from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSPolicyKind, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions

QOS_OVERRIDES = 'qos_overrides.'
"""Prefix of the names of these parameters."""

PUBLISHER_OVERRIDES = QoSOverridingOptions.with_default_policies()
SUBSCRIPTION_OVERRIDES = QoSOverridingOptions((
    QoSPolicyKind.RELIABILITY, QoSPolicyKind.DURABILITY))
"""Without the depth, which the node chooses."""

LARGEST_DEPTH = 2**31 - 1
"""Largest depth of a queue that rclpy and Fast DDS accept."""

_VALUES = {
    policy: [value.name.lower() for value in values if value.name != 'UNKNOWN']
    for policy, values in (
        ('reliability', ReliabilityPolicy), ('durability', DurabilityPolicy),
        ('history', HistoryPolicy))}


def sentences_about_overrides(given: Mapping[str, Parameter]) -> list[str]:
    """
    Find values that their policy does not have.

    :param given: the parameters that were given when the node was started, by names.
    :return: a sentence for each, with the parameter, the value and the rule.
    """
    sentences = []
    for name, parameter in given.items():
        policy, value = name.rpartition('.')[2], parameter.value
        if policy in _VALUES:
            rule, is_allowed = f'one of {", ".join(_VALUES[policy])}', value in _VALUES[policy]
        else:
            rule = f'an integer from 0 to {LARGEST_DEPTH}'
            is_allowed = policy != 'depth' or (
                parameter.type_ is Parameter.Type.INTEGER and 0 <= value <= LARGEST_DEPTH)
        if name.startswith(QOS_OVERRIDES) and not is_allowed:
            sentences.append(f'parameter {name} is {value}; it must be {rule}')
    return sentences
