# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Transforms of a file as messages, without the node."""

import pytest
from sdf_texts import model_file

from sdf_pose_bridge import SdfError
from sdf_pose_bridge.errors import AddressError
from sdf_pose_bridge.ros.parameters.declarations import SettingsError
from sdf_pose_bridge.ros.transforms import transforms_from_parameters

ROBOT = model_file(
    '<link name="l"/><frame name="f"><pose degrees="true">1 2 3 180 0 0</pose></frame>')


@pytest.mark.parametrize(('parameters', 'error', 'message'), [
    ({}, SettingsError, 'sdf_file is not set'),
    ({'robot_description': ROBOT, 'kinds': ['lnk']}, SettingsError, 'lnk'),
    ({'robot_description': ROBOT, 'frame_prefx': 'a/'}, SettingsError,
     'there is no parameter frame_prefx; did you mean "frame_prefix"'),
    ({'sdf_file': 'model://none'}, AddressError, 'none'),
    ({'robot_description': '<sdf/>'}, SdfError, 'version'),
])
def test_wrong_parameters_raise_an_error(parameters, error, message):
    with pytest.raises(error, match=message):
        transforms_from_parameters(**parameters)


def test_a_transform_is_the_pose_of_a_frame_in_its_parent():
    model, frame = transforms_from_parameters(robot_description=ROBOT)
    assert (model.header.frame_id, model.child_frame_id) == ('l', 'm')
    assert (frame.header.frame_id, frame.child_frame_id) == ('m', 'f')
    xyz, quat = frame.transform.translation, frame.transform.rotation
    assert (xyz.x, xyz.y, xyz.z) == (1.0, 2.0, 3.0)
    assert (quat.x, quat.y, quat.z, quat.w) == pytest.approx((1.0, 0.0, 0.0, 0.0))
    assert (frame.header.stamp.sec, frame.header.stamp.nanosec) == (0, 0)


def test_parameters_are_those_of_the_node():
    transforms = transforms_from_parameters(
        robot_description=ROBOT, model_name='r', frame_prefix='p/', root_frame='map',
        anchor_models='all')
    assert {each.child_frame_id: each.header.frame_id for each in transforms} == {
        'p/r/l': 'map', 'p/r': 'p/r/l', 'p/r/f': 'p/r'}
