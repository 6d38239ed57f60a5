# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What the commands that show frames share."""

import math

from sdf_texts import model_file

from sdf_pose_bridge import load_text
from sdf_pose_bridge.cli.frames import default_references_of
from sdf_pose_bridge.cli.frames import Units
from sdf_pose_bridge.geometry.poses import Pose


def test_pose_is_written_in_units():
    pose = Pose(1.25, -0.00001, 3.0, 0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))
    assert Units(is_mm=False, is_degrees=False).texts(pose) == [
        '1.2500', '0.0000', '3.0000', '0.0000', '0.0000', '1.5708']
    assert Units(is_mm=True, is_degrees=True).texts(pose) == [
        '1250.0', '0.0', '3000.0', '0.00', '0.00', '90.00']


def test_default_reference_depends_on_the_kind():
    scene = load_text(model_file(
        '<link name="a"><visual name="v"><geometry><empty/></geometry></visual></link>'
        '<link name="b"><pose relative_to="a"/></link><frame name="f" attached_to="a"/>'
        '<frame name="g"/>'
        '<joint name="j" type="fixed"><parent>a</parent><child>b</child></joint>'))
    defaults = {
        scene.own_name(element): None if reference < 0 else scene.own_name(reference)
        for element, reference in enumerate(default_references_of(scene))}
    assert defaults == {
        '__root__': None, 'm': '__root__', 'a': 'm', 'v': 'a', 'b': 'm', 'f': 'a', 'g': 'm',
        'j': 'b'}
