# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""How the numbers of a pose are edited; integration/test_view_page.py drags a frame and types."""

import math
import re

import pytest

pytest.importorskip('viser', reason='needs viser')
import viser

from sdf_pose_bridge.cli.printing import DEGREES, MILLIMETRES, Units
from sdf_pose_bridge.cli.viewer.pose_edit import EditedFrame, PoseEdit
from sdf_pose_bridge.cli.viewer.server import Events
from sdf_pose_bridge.errors import ElementInvalidError
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.rotations import quaternion_from_rpy, rpy_from_quaternion
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.scene.pose_setting import PoseChange
from sdf_pose_bridge.sdformat.file_change import FileChange

TEXT = b"""<sdf version="1.11"><model name="m"><link name="l"/>
  <frame name="free"/><frame name="fixed"/></model></sdf>"""
SCENE = load_text(TEXT, 'm.sdf')
POSE = Pose(*(0.123456789, 0.0, 0.0, *quaternion_from_rpy((0.0, 0.0, 0.123456789))))


@pytest.fixture
def written():
    """The poses that were written, and the edit."""
    poses = []

    def put(scene, element, pose, measured, *, dry_run):
        """Refuse to place one of the frames, as the file cannot say some poses."""
        if scene.names[element].endswith('fixed'):
            raise ElementInvalidError('no', scene.place(element))
        if not dry_run:
            poses.append(pose)
        return PoseChange(FileChange(scene.path, 'utf-8', b'', b'', b'', b''), 1, scene)
    server = viser.ViserServer('127.0.0.1', 0, verbose=False)
    yield poses, PoseEdit(server, put, Events(), lambda: None)
    server.stop()


def edited(name, x=0.0):
    element = [each.rpartition('::')[2] for each in SCENE.names].index(name)
    return EditedFrame(
        SCENE, element, POSE, Pose(x=x), name, lambda scene, element: POSE)


def drag(edit, z):
    """Move the gizmo to (0, 0, z), as a browser does."""
    edit._gizmo.position, edit._gizmo.wxyz = (0.0, 0.0, z), (1.0, 0.0, 0.0, 0.0)
    edit._take_gizmo()


def test_cancelled_edit_moves_the_gizmo_back(written):
    _, edit = written
    edit.begin(edited('free'), Units())
    drag(edit, 1.0)
    assert [number.value for number in edit._numbers[:3]] == [0.0, 0.0, 1.0]
    edit._cancel_edit()
    assert edit.pose is None
    assert edit._gizmo.position.tolist() == list(POSE[:3])
    assert edit._numbers[0].value == 0.1235


def test_only_frames_that_can_be_placed_are_edited(written):
    _, edit = written
    for name, is_possible in (('free', True), ('fixed', False), ('free', True)):
        edit.begin(edited(name), Units())
        assert edit._gizmo.visible is is_possible
        assert [number.disabled for number in edit._numbers] == [not is_possible] * 6
        assert ('errors_of_setting' in edit.html) is not is_possible
    edit.begin(None, Units())
    assert not edit._gizmo.visible


def test_numbers_that_were_not_typed_stay_exact(written):
    poses, edit = written
    edit.begin(edited('free'), Units(MILLIMETRES, DEGREES))
    assert [number.value for number in edit._numbers] == [123.5, 0, 0, 0, 0, 7.07]
    edit._numbers[1].value = 250.0
    edit._numbers[3].value = 90.0
    edit._take_numbers()
    edit._write_pose()
    assert poses[0][:3] == pytest.approx((0.123456789, 0.25, 0.0), abs=1e-15)
    assert rpy_from_quaternion(poses[0][3:]) == pytest.approx((math.pi / 2, 0.0, 0.123456789))


def test_typed_numbers_in_another_unit_are_asked_about(written):
    _, edit = written
    edit.begin(edited('free'), Units())
    edit._numbers[5].value = 90.0
    edit._take_numbers()
    assert 'the angles 0 0 90 are radians; did you mean degrees?' in edit.html


def test_numbers_are_relative_to_the_reference(written):
    _, edit = written
    edit.begin(edited('free', 1.0), Units())
    assert edit._numbers[0].value == -0.8765
    edit._numbers[0].value = -1.0
    edit._take_numbers()
    assert edit.pose[:3] == pytest.approx((0.0, 0.0, 0.0))


def test_new_pose_stays_while_the_frame_does_not_move(written):
    _, edit = written
    edit.begin(edited('free'), Units())
    drag(edit, 1.0)
    edit.begin(edited('free')._replace(scene=load_text(TEXT, 'm.sdf')), Units())
    assert edit.pose == Pose(z=1.0)
    edit.begin(edited('free')._replace(pose=Pose()), Units())
    assert edit.pose is None


def test_scene_with_a_new_pose_is_found_until_it_is_cancelled(written):
    poses, edit = written
    edit.begin(edited('free'), Units())
    edit.look_ahead()
    assert edit.scene_ahead is None
    drag(edit, 1.0)
    edit.look_ahead()
    drag(edit, 2.0)
    assert (edit.scene_ahead, poses) == (SCENE, [])
    edit._cancel_edit()
    assert edit.scene_ahead is None


def test_pose_that_cannot_be_written_is_an_error_before_it_is(written):
    _, edit = written
    edit.begin(edited('free'), Units())
    drag(edit, 1.0)
    edit._frame = edited('fixed')
    edit.look_ahead()
    assert edit.scene_ahead is None
    assert 'class="errors"' in edit.html


def test_what_is_written_is_the_old_pose_then(written):
    poses, edit = written
    edit.begin(edited('free'), Units())
    drag(edit, 1.0)
    edit._write_pose()
    assert (poses, edit.pose) == ([Pose(z=1.0)], None)
    assert edit._gizmo.position.tolist() == [0.0, 0.0, 1.0]


def test_new_pose_stays_for_the_same_frame_only(written):
    _, edit = written
    edit.begin(edited('free'), Units())
    drag(edit, 1.0)
    edit.begin(edited('free', 1.0), Units(angle=DEGREES))
    assert edit.pose == Pose(z=1.0)
    assert 'class="difference"' in edit.html
    edit.begin(edited('l'), Units())
    assert edit.pose is None
    assert 'class="difference"' not in edit.html


def test_only_buttons_that_can_be_used_have_labels(written):
    _, edit = written

    def labels():
        return re.findall('<label[^>]*>(.*?)</label>', edit.html)
    edit.begin(edited('free'), Units())
    assert labels() == []
    drag(edit, 1.0)
    assert labels() == [*edit.actions] == ['write to file', 'cancel']
    edit._write_pose()
    assert labels() == ['undo the last write']


def test_steps_are_in_the_units_of_the_numbers(written):
    _, edit = written
    edit.begin(edited('free'), Units(MILLIMETRES, DEGREES))
    assert edit._steps.value == '1 mm, 0.1 deg'
    edit._steps.value = '10 mm, 1 deg'
    edit._set_steps()
    assert [number.step for number in edit._numbers] == pytest.approx([10.0] * 3 + [1.0] * 3)
