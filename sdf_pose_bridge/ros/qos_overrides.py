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
    'reliability': ReliabilityPolicy, 'durability': DurabilityPolicy, 'history': HistoryPolicy}


def sentences_about_overrides(given: Mapping[str, Parameter]) -> list[str]:
    """
    Find values that their policy does not have.

    :param given: the parameters that were given when the node was started, by names.
    :return: a sentence for each, with the parameter, the value and the rule.
    """
    sentences = []
    for name, parameter in given.items():
        policy, value = name.rpartition('.')[2], parameter.value
        known = [each.name.lower() for each in _VALUES.get(policy, ()) if each.name != 'UNKNOWN']
        rule = ''
        if known and value not in known:
            rule = f'one of {", ".join(known)}'
        elif policy == 'depth' and (
                parameter.type_ is not Parameter.Type.INTEGER or not 0 <= value <= LARGEST_DEPTH):
            rule = f'an integer from 0 to {LARGEST_DEPTH}'
        if rule and name.startswith(QOS_OVERRIDES):
            sentences.append(f'parameter {name} is {value}; it must be {rule}')
    return sentences
