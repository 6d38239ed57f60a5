# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Parameters that override the quality of service of topics, as nodes of rclcpp and rclpy have them.

Their names are ``qos_overrides.<topic>.<publisher or subscription>.<policy>``. They are declared
where they are given.
"""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Sequence

from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy
from rclpy.qos import HistoryPolicy
from rclpy.qos import QoSPolicyKind
from rclpy.qos import ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions

QOS_OVERRIDES = 'qos_overrides.'
"""How the names of these parameters begin."""

POLICIES_OF_PUBLISHER = (
    QoSPolicyKind.HISTORY, QoSPolicyKind.DEPTH, QoSPolicyKind.RELIABILITY)
POLICIES_OF_SUBSCRIPTION = (QoSPolicyKind.RELIABILITY, QoSPolicyKind.DURABILITY)
"""Without the depth, which follows from how messages are taken."""

_VALUES = {
    'reliability': ReliabilityPolicy, 'durability': DurabilityPolicy, 'history': HistoryPolicy}


def overriding_options(
    node: Node, topic: str, entity: str, policies: Sequence[QoSPolicyKind],
) -> QoSOverridingOptions | None:
    """
    Return what parameters override for a topic.

    :param topic: its name, before it is remapped.
    :param entity: ``publisher`` or ``subscription``.
    :param policies: what can be overridden.
    :return: the policies for which parameters are given; None if there are none.
    """
    begin = f'{QOS_OVERRIDES}{node.resolve_topic_name(topic)}.{entity}.'
    # rclpy shows in no public way what was given.
    given = [
        policy for policy in policies
        if begin + policy.name.lower() in node._parameter_overrides]  # noqa: SLF001
    return QoSOverridingOptions(given) if given else None


def sentences_about_overrides(given: Mapping[str, Parameter]) -> list[str]:
    """
    Find values that are not those of their policy.

    :param given: what was given when the node was started, by names.
    :return: a sentence for each, with the parameter, the value and the rule.
    """
    sentences = []
    for name, parameter in given.items():
        policy = name.rpartition('.')[2]
        if not name.startswith(QOS_OVERRIDES):
            continue
        if policy in _VALUES:
            known = [
                value.name.lower() for value in _VALUES[policy] if value.name != 'UNKNOWN']
            if parameter.value not in known:
                sentences.append(
                    f'parameter {name} is {parameter.value}; it must be one of '
                    f'{", ".join(known)}')
        elif policy == 'depth' and (
                parameter.type_ is not Parameter.Type.INTEGER or parameter.value < 0):
            sentences.append(
                f'parameter {name} is {parameter.value}; it must be an integer, not below zero')
    return sentences
