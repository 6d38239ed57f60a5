# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Read the ``<gazebo>`` elements of a robot: settings, and SDFormat for its links and joints."""

from __future__ import annotations

from typing import NamedTuple

from sdf_pose_bridge.sdformat.urdf.values import is_true
from sdf_pose_bridge.sdformat.xml_tree import child_elements
from sdf_pose_bridge.sdformat.xml_tree import XmlElement

_SETTINGS = frozenset({
    'canonicalBody', 'cfmDamping', 'collision', 'dampingFactor', 'disableFixedJointLumping',
    'fdir1', 'fudgeFactor', 'implicitSpringDamper', 'kd', 'kp', 'laserRetro', 'material',
    'maxContacts', 'maxVel', 'minDepth', 'mu1', 'mu2', 'preserveFixedJoint', 'provideFeedback',
    'selfCollide', 'springReference', 'springStiffness', 'static', 'stopCfm', 'stopErp',
    'turnGravityOff', 'visual',
})
"""Children of ``<gazebo>`` that are not SDFormat."""


class Settings(NamedTuple):
    """What ``<gazebo>`` elements say about the conversion."""

    static: str | None
    """The text of ``<static>`` of the model; None if there is none."""
    kept_joints: frozenset[str]
    """Names of fixed joints that remain joints."""
    revolute_joints: frozenset[str]
    """Those of them that become revolute joints."""


def settings_and_extensions_from_robot(
    root: XmlElement,
) -> tuple[Settings, dict[str, list[XmlElement]]]:
    """
    Read all ``<gazebo>`` elements.

    :param root: the ``robot`` element.
    :return: the settings; and the elements of SDFormat by the name of the link or joint that they
        are for, which is empty for the model.
    """
    static: str | None = None
    preserved: set[str] = set()
    revolute: set[str] = set()
    extensions: dict[str, list[XmlElement]] = {}
    for gazebo in child_elements(root, 'gazebo'):
        reference = gazebo.get('reference', '')
        for child in child_elements(gazebo):
            if child.tag not in _SETTINGS:
                extensions.setdefault(reference, []).append(child)
            elif child.tag == 'static' and not reference:
                static = str(is_true(child)).lower()
            elif child.tag == 'preserveFixedJoint' and is_true(child):
                preserved.add(reference)
            elif child.tag == 'disableFixedJointLumping' and is_true(child):
                revolute.add(reference)
    settings = Settings(
        static, frozenset(preserved | revolute), frozenset(revolute - preserved))
    return settings, extensions
