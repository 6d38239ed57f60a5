# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""How a frame is selected, and the numbers of its pose are edited; page/ drags it and types."""

import math
import re
from threading import Event

import pytest

pytest.importorskip('viser', reason='needs viser')

from sdf_pose_bridge.cli.viewer.selected_frame import PoseEdit, SelectedFrame
from sdf_pose_bridge.cli.viewer.server import Events
from sdf_pose_bridge.cli.viewer.shown_scene import ShownScene
from sdf_pose_bridge.errors import ElementInvalidError
from sdf_pose_bridge.export.pose_setting import PoseChange
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.rotations import quaternion_from_rpy, rpy_from_quaternion
from sdf_pose_bridge.geometry.units import DEGREES, MILLIMETRES, Units
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.tf.tree import TfOptions

TEXT = """<sdf version="1.11"><model name="m"><link name="l"/>
  <frame name="free"/><frame name="fixed"/></model></sdf>"""
UNITS = Units()


def scene_with(pose):
    """Return the scene with another pose of the free frame."""
    numbers = ' '.join(map(str, (*pose[:3], *rpy_from_quaternion(pose[3:]))))
    return load_text(TEXT.replace(
        '"free"/>', f'"free"><pose>{numbers}</pose></frame>').encode(), 'm.sdf')


SCENE = load_text(TEXT.encode(), 'm.sdf')
POSE = Pose(*(0.123456789, 0.0, 0.0, *quaternion_from_rpy((0.0, 0.0, 0.123456789))))


class Change:
    """A change of a file that is only noted."""

    path = 'm.sdf'

    def __init__(self, pose, written):
        self._pose, self._written, self.undone = pose, written, self

    def write(self):
        self._written.append(self._pose)


@pytest.fixture
def written():
    """The poses that were written."""
    return []


@pytest.fixture
def edit(server, written):
    def change(scene, element, pose, measured):
        """Refuse some poses, as a file cannot say them."""
        if scene.names[element].endswith('fixed') or pose.z > 5.0:
            raise ElementInvalidError('no', scene.place(element))
        return PoseChange(Change(pose, written), 1, scene_with(pose))

    def show_file(shown):
        show(edit, scene=shown.loaded, pose=shown.pose_of(edit._frame))

    edit = PoseEdit(server, ShownScene(SCENE, TfOptions()), change, Events(Event()), show_file)
    return edit


def show(edit, name='free', *, x=0.0, pose=POSE, scene=SCENE, units=UNITS):
    """Show a frame at a pose, relative to one at (x, 0, 0), as a page that has time does."""
    shown = ShownScene(scene, TfOptions())
    frame, reference = map(shown.ids.index, (name, 'm'))
    shown = shown.with_pose(frame, pose).with_pose(reference, Pose(x=x))
    edit.refresh(shown, frame, reference, units)
    edit.look_ahead()
    edit.refresh(shown, frame, reference, units)


def drag(edit, z):
    """Move the gizmo to (0, 0, z), as a browser does."""
    edit._gizmo.position, edit._gizmo.wxyz = (0.0, 0.0, z), (1.0, 0.0, 0.0, 0.0)
    show(edit)


def texts(edit):
    return [number.value for number in edit._numbers]


def test_cancelled_edit_moves_the_gizmo_back(edit):
    show(edit)
    drag(edit, 1.0)
    assert texts(edit)[:3] == ['0.0000', '0.0000', '1.0000']
    edit.actions['cancel']()
    show(edit)
    assert edit.pose is None
    assert edit._gizmo.position.tolist() == list(POSE[:3])
    assert texts(edit)[0] == '0.1235'


def test_only_frames_that_can_be_placed_are_edited(edit):
    for name, is_possible in (('free', True), ('fixed', False), ('free', True)):
        show(edit, name)
        assert edit._gizmo.visible is is_possible
        assert [number.disabled for number in edit._numbers] == [not is_possible] * 6
        assert ('class="errors_of_setting"' in edit.html) is not is_possible
    edit.refresh(ShownScene(SCENE, TfOptions()), -1, -1, UNITS)
    assert not edit._gizmo.visible


def test_numbers_that_were_not_typed_stay_exact(edit, written):
    units = Units(MILLIMETRES, DEGREES)
    show(edit, units=units)
    assert texts(edit) == ['123.5', '0.0', '0.0', '0.00', '0.00', '7.07']
    edit._numbers[1].value = '250'
    edit._numbers[3].value = '90'
    show(edit, units=units)
    edit.actions['write to file']()
    assert written[0][:3] == pytest.approx((0.123456789, 0.25, 0.0), abs=1e-15)
    assert rpy_from_quaternion(written[0][3:]) == pytest.approx((math.pi / 2, 0.0, 0.123456789))


def test_typed_digits_stay(edit):
    show(edit)
    for typed in ('0.123456', '0.1234561', ' 6.1e-05', '-.25', '\u2212.5'):
        edit._numbers[0].value = typed
        show(edit)
        assert texts(edit)[0] == typed
        assert edit.pose.x == pytest.approx(float(typed.replace('\u2212', '-')), abs=1e-12)


@pytest.mark.parametrize(
    'typed', ['', '-', '1/2', '1,234.5', '-0,25', '1 2', '1_0', 'nan', '1e999'])
def test_text_that_is_no_number_is_refused(edit, written, typed):
    show(edit)
    drag(edit, 1.0)
    edit._numbers[0].value = typed
    write = edit.actions['write to file']
    show(edit)
    assert (texts(edit)[0], edit.pose, [*edit.actions]) == (typed, Pose(z=1.0), ['cancel'])
    assert 'class="errors"' in edit.html
    write()
    assert written == []
    edit.actions['cancel']()
    show(edit)
    assert (texts(edit)[0], [*edit.actions]) == ('0.1235', [])
    assert 'class="errors"' not in edit.html


@pytest.mark.parametrize(('pasted', 'yaw'), [
    ('<pose>1 2 3 0 0 0.5</pose>', 0.5), ('1 2 3 0 0 30', math.radians(30)),
    ('{X 1000, Y 2000, Z 3000, A 30, B 0, C 0}', math.radians(30)),
    ('x: 0 y: 0 z: 1 w: 0', math.pi), ('p[1,2,3,0,0,0.5]', 0.5),
    ('xyz="1 2 3"rpy="0 0 0.5"', 0.5), ('1,2,3,0,0,30', math.radians(30)),
    ('position:  x: 1  y: 2  z: 3orientation:  z: 0.6  w: 0.8', 2 * math.atan2(0.6, 0.8))])
def test_pose_that_is_pasted_into_a_field_is_read_as_by_the_commands(edit, pasted, yaw):
    units, pose = Units(angle=DEGREES), Pose(1.0, 2.0, 3.0)
    show(edit, pose=pose, units=units)
    edit._numbers[2].value = pasted
    show(edit, pose=pose, units=units)
    assert edit.pose[:3] == (1.0, 2.0, 3.0)
    assert rpy_from_quaternion(edit.pose[3:]) == pytest.approx((0.0, 0.0, yaw))
    assert texts(edit)[2] == '3.0000'


@pytest.mark.parametrize(('number', 'text', 'question'), [
    (2, 'x: 0 y: 0 z: 45 w: 1', 'the quaternion 0 0 45 1 has the length 45'),
    (5, '90', 'the angles 0 0 90 are radians; did you mean degrees?')])
def test_numbers_in_doubt_are_asked_about(edit, number, text, question):
    show(edit)
    edit._numbers[number].value = text
    show(edit)
    assert question in edit.html
    assert [*edit.actions] == ['write anyway', 'cancel']


def test_refused_text_goes_when_another_frame_is_selected(edit):
    show(edit)
    edit._numbers[1].value = '-'
    show(edit)
    show(edit, 'l')
    assert texts(edit)[1] == '0.0000'


def test_numbers_are_relative_to_the_reference(edit):
    show(edit, x=1.0)
    assert texts(edit)[0] == '-0.8765'
    edit._numbers[0].value = '-1'
    show(edit, x=1.0)
    assert edit.pose[:3] == pytest.approx((0.0, 0.0, 0.0))


@pytest.mark.parametrize(('name', 'options', 'stays'), [
    ('free', {'scene': scene_with(Pose())}, True), ('free', {'pose': Pose()}, False),
    ('free', {'x': 1.0, 'units': Units(angle=DEGREES)}, True), ('l', {}, False)])
def test_new_pose_stays_while_its_frame_is_selected_and_does_not_move(
        edit, name, options, stays):
    show(edit)
    drag(edit, 1.0)
    show(edit, name, **options)
    assert edit.pose == (Pose(z=1.0) if stays else None)
    assert ('class="difference"' in edit.html) is stays


def test_scene_with_a_new_pose_is_shown_until_it_is_cancelled(edit, written):
    show(edit)
    assert edit.shown_ahead is edit._shown
    drag(edit, 1.0)
    assert not edit.look_ahead()
    assert edit.shown_ahead.pose_of(edit._frame) == Pose(z=1.0)
    assert written == []
    edit.actions['cancel']()
    assert edit.shown_ahead is edit._shown


def test_pose_that_cannot_be_written_is_an_error_before_it_is(edit, written):
    show(edit)
    drag(edit, 9.0)
    assert 'class="errors"' in edit.html
    edit.actions['write to file']()
    assert written == []


def table(edit):
    """Return the old and the new numbers."""
    return [*zip(*re.findall('<tr><td>.*?]</td><td>(.*?)</td><td>(.*?)</td>', edit.html),
                 strict=True)]


def test_what_is_written_is_shown_beside_what_it_replaced(edit, written):
    def buttons():
        return re.findall('<button[^>]*>(.*?)</button>', edit.html)
    show(edit)
    assert (buttons(), table(edit)) == ([], [])
    drag(edit, 1.0)
    numbers = table(edit)
    assert numbers[1] == ('0.0000', '0.0000', '1.0000', '0.0000', '0.0000', '0.0000')
    assert buttons() == [*edit.actions] == ['write to file', 'cancel']
    edit.actions['write to file']()
    assert (written, edit.pose, buttons()) == ([Pose(z=1.0)], None, ['undo the last write'])
    assert 'written to m.sdf:1<' in edit.html
    assert (table(edit), texts(edit)) == (numbers, [*numbers[1]])
    # The file is read again.
    show(edit, scene=scene_with(Pose(z=1.0)), pose=Pose(z=1.0))
    assert table(edit) == numbers
    edit.actions['undo the last write']()
    assert 'written to' not in edit.html
    assert table(edit) == []


def test_each_write_is_undone_the_last_one_first(edit, written):
    scene = scene_with(Pose())
    show(edit, scene=scene, pose=Pose())
    for z in (0.0, 1.0):
        edit._gizmo.position = (0.0, 0.0, z + 1.0)
        show(edit, scene=scene_with(Pose(z=z)), pose=Pose(z=z))
        edit.actions['write to file']()
    assert [pose.z for pose in written] == [1.0, 2.0]
    for is_left in (True, False):
        edit.actions['undo the last write']()
        assert ('undo the last write' in edit.actions) is is_left
    assert [pose.z for pose in written[2:]] == [2.0, 1.0]


def test_table_of_a_written_pose_goes_with_the_frame(edit):
    show(edit)
    drag(edit, 1.0)
    edit.actions['write to file']()
    show(edit, 'l')
    assert table(edit) == []


def test_frame_of_the_numbers_is_named(edit):
    edit.refresh(ShownScene(SCENE, TfOptions()), -1, -1, UNITS)
    assert 'select a frame' in edit._frame_of_numbers.content
    show(edit)
    assert 'free in <b>m</b>' in edit._frame_of_numbers.content


def shown_scene(*frames):
    text = ''.join(f'<frame name="{name}"/>' for name in frames)
    scene = load_text(
        f'<sdf version="1.11"><world name="w">{text}</world></sdf>'.encode(), 'cell.sdf')
    return ShownScene(scene, TfOptions())


@pytest.fixture
def selected(server):
    selected = SelectedFrame(server.gui, server.gui.add_folder(''), Events(Event()))
    selected.list_frames(shown_scene('a', 'b', 'c'))
    return selected


def test_frame_that_is_gone_is_not_selected(selected):
    selected.answer('select', 'gone')
    assert selected.frame == -1


def test_selected_frame_stays_where_others_are_listed(selected):
    selected.answer('select', 'b')
    selected.list_frames(shown_scene('b'))
    assert selected.frame == 0
    selected.list_frames(shown_scene('a'))
    assert selected.frame == -1
