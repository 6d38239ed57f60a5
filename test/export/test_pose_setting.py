# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What a file must say so that an element is at a pose."""

from functools import partial
import re

from matrices import assert_close
import numpy as np
import pytest
from sdf_texts import fixed_joint, model_file, posed, world_file, write_files
import urdf_texts

from sdf_pose_bridge import load, load_text, Pose
from sdf_pose_bridge.errors import PoseNotSetError, SdfError
from sdf_pose_bridge.export.pose_setting import pose_change, write_frame_change
from sdf_pose_bridge.export.published_scene import fingerprint_of_scene, LoadRequest
from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request
from sdf_pose_bridge.geometry.poses import canonical_relative_pose
from sdf_pose_bridge.tf.lookup import lookup_from_scene
from sdf_pose_bridge.tf.tree import TfOptions

ASKED = Pose(0.5, -1.0, 2.0, 0.5, 0.5, 0.5, 0.5)
MODEL = model_file(posed('link', 'a', '1 0 0 0 0 0') + posed('frame', 'f', '0 1 0 0 0 1', 'a'))
PLACED = model_file(
    '<pose>1 2 3 0 1 0</pose><link name="a"><pose>0 0 1 0 0 2</pose></link>',
    attributes='placement_frame="a"')
TWICE = world_file(
    '<include><uri>m.sdf</uri><name>x</name><pose>5 0 0 0 0 0</pose></include>\n'
    '<include><uri>m.sdf</uri><name>y</name></include>')

ROBOT = urdf_texts.robot(
    ''.join(map(urdf_texts.link, ('base', 'arm', 'eye', 'optical')))
    + urdf_texts.joint(
        'turn', 'base', 'arm', 'continuous', urdf_texts.origin('0 1 0', '0 0 0.5'))
    + urdf_texts.joint(
        'mount', 'arm', 'eye', 'fixed', urdf_texts.origin('0.2 0 0.1', '0 0.3 0'))
    + urdf_texts.joint('rep103', 'eye', 'optical', 'fixed', urdf_texts.origin(
        rpy='-1.5708 0 -1.5708')))


@pytest.fixture(name='change')
def make_change(tmp_path):
    def change(name, relative_to='', *, file='m', **options):
        path = str(tmp_path / f'{file}.sdf')

        scene = load(path)
        made = pose_change(
            scene, scene.index(name), ASKED, lookup_from_scene, partial(load, path),
            relative_to=relative_to, **options)
        assert_close(canonical_relative_pose(
            made.scene.pose(name, relative_to), ASKED)[:6], 0.0, 1e-9)
        return made
    return change


@pytest.mark.parametrize(('text', 'name', 'relative_to'), [
    (MODEL, 'm::f', ''),
    (MODEL, 'm::f', 'm::a'),
    (MODEL, 'm::a', ''),
    (MODEL, 'm', ''),
    # The frame that the pose is relative to is turned.
    (MODEL.replace('1 0 0 0 0 0', '1 0 0 0.2 0 1'), 'm::f', ''),
    # Digits that are enough near the placement frame are too few at the model frame.
    (PLACED.replace('0 0 1 0 0 2', '0 0 300 0 0 2'), 'm', ''),
    (model_file('<link name="a"/><link name="b"/>' + fixed_joint('j', 'a', 'b')), 'm::j', 'm::a'),
    (model_file('<link name="a"><sensor name="s" type="camera"/></link>'), 'm::a::s', 'm'),
    # The pose of the model is that of its placement frame.
    (PLACED, 'm', ''),
    (PLACED, 'm::a', 'm'),
    (PLACED, 'm::a', ''),
    (MODEL.replace('1.9', '1.4').replace('relative_to="a"', ''), 'm::a', ''),
])
def test_the_pose_is_what_was_asked_for(change, tmp_path, text, name, relative_to):
    write_files(tmp_path, m=text)
    made = change(name, relative_to)
    assert made.file.path == str(tmp_path / 'm.sdf')
    assert made.file.undone.new_text == text.encode()


def test_a_written_quaternion_has_a_positive_w(change, tmp_path):
    write_files(tmp_path, m=MODEL.replace('1 0 0 0 0 0', '1 0 0 0 0 -3').replace(
        '<pose relative_to="a">0 1 0 0 0 1',
        '<pose relative_to="a" rotation_format="quat_xyzw">0 1 0 0 0 0 1'))
    text = change('m::f').file.new_text.decode()
    assert float(text.partition('quat_xyzw">')[2].partition('<')[0].split()[6]) > 0.0


def test_what_does_not_depend_on_it_stays_to_the_last_bit(change, tmp_path):
    write_files(tmp_path, m=MODEL)
    before = load(tmp_path / 'm.sdf')
    after = change('m::f').scene
    assert before.pose('m::a') == after.pose('m::a')


def test_the_pose_of_an_included_model_is_set_in_the_include(change, tmp_path):
    write_files(tmp_path, m=MODEL, w=TWICE)
    made = change('x', file='w')
    assert (made.file.path, made.line) == (str(tmp_path / 'w.sdf'), 1)
    assert made.file.new_text == TWICE.encode().replace(
        b'5 0 0 0 0 0', b'0.5 -1 2 1.570796327 0 1.570796327')


def test_an_include_without_a_pose_gets_one(change, tmp_path):
    write_files(tmp_path, m=MODEL.replace('<link', '<pose>7 0 0 0 0 0</pose><link', 1), w=TWICE)
    made = change('y', file='w')
    assert b'<include><pose>0.5 -1 2 1.570796327 0 1.570796327</pose><uri>m.sdf</uri><name>y' in (
        made.file.new_text)


def test_an_element_of_a_file_that_is_included_twice(change, tmp_path):
    write_files(tmp_path, m=MODEL, w=TWICE)
    with pytest.raises(PoseNotSetError, match='also places "y::a"') as caught:
        change('x::a', file='w')
    assert caught.value.place == (str(tmp_path / 'm.sdf'), 1, '')
    assert change('x::a', file='w', all_instances=True).file.path == str(tmp_path / 'm.sdf')
    write_files(tmp_path, m=MODEL.replace('name="m"', 'name="m" placement_frame="f"'))
    with pytest.raises(PoseNotSetError, match='also places "y::a"'):
        change('x::a', file='w')


def test_a_merged_model_and_what_was_in_it(change, tmp_path):
    merged = model_file('<link name="base"/>\n<include merge="true"><uri>m.sdf</uri></include>')
    write_files(tmp_path, m=MODEL, w=merged)
    assert change('m::_merged__m__model__', file='w').file.path == str(tmp_path / 'w.sdf')
    assert change('m::f', 'm::base', file='w').file.path == str(tmp_path / 'm.sdf')


def test_a_pose_that_parameters_set_is_set_there(change, tmp_path):
    write_files(tmp_path, m=MODEL.replace('"f"', '"grip"'), w=world_file(
        '<include><uri>m.sdf</uri><experimental:params>\n<frame element_id="grip" action="modify">'
        '<pose>9 0 0 0 0 0</pose></frame></experimental:params></include>'))
    made = change('m::grip', file='w')
    assert (made.file.path, made.line) == (str(tmp_path / 'w.sdf'), 2)


@pytest.mark.parametrize(('params', 'reason'), [
    ('<visual element_id="base::box" action="remove"><pose/></visual>', 'parameters of an incl'),
    ('<link element_id="base"><visual name="box" action="modify"><layer>1</layer></visual></link>',
     'would not be valid: .* has no <pose>'),
])
def test_a_pose_that_parameters_forbid_is_refused(change, tmp_path, params, reason):
    visual = '<visual name="box">{}<layer>0</layer><geometry/></visual>'
    pose = '<pose>1 0 0 0 0 0</pose>' if 'remove' in params else ''
    write_files(
        tmp_path, m=model_file(f'<link name="base">{visual.format(pose)}</link>'),
        w=world_file('<include><uri>m.sdf</uri><experimental:params>'
                     f'{params}</experimental:params></include>'))
    with pytest.raises(PoseNotSetError, match=reason):
        change('m::base::box', file='w')


@pytest.mark.parametrize(('text', 'name', 'relative_to', 'reason'), [
    (MODEL, 'm::a', 'm::f', 'moves with it'),
    (MODEL, '__root__', '', 'all others are placed'),
    (world_file('<actor name="a"><skin><filename>a.dae</filename></skin></actor>'), 'a', '',
     'it is an actor'),
    (model_file(
        '<link name="a"><inertial auto="true"/><collision name="c"><density>1</density><geometry>'
        '<box><size>1 1 1</size></box></geometry></collision></link>'), 'm::a::inertial', '',
     'computed from the collisions'),
    (f'<robot name="m">{urdf_texts.link("a")}</robot>', 'm::a', '', 'no <origin> of a joint'),
    (ROBOT, 'r::eye', 'r::optical', 'no <origin> of a joint'),
    (MODEL.replace('1.9', '1.3').replace('relative_to="a"', ''), 'm::a', '', 'SDFormat 1.3'),
])
def test_what_no_pose_can_say_is_refused(change, tmp_path, text, name, relative_to, reason):
    write_files(tmp_path, m=text)
    with pytest.raises(PoseNotSetError, match=reason):
        change(name, relative_to)


def test_a_file_that_has_changed_since_it_was_read_is_refused(tmp_path):
    write_files(tmp_path, m=MODEL)
    path = str(tmp_path / 'm.sdf')
    scene = load(path)
    write_files(tmp_path, m=MODEL.replace('1 0 0 0 0 0', '2 0 0 0 0 0'))
    with pytest.raises(PoseNotSetError, match='has changed since it was read'):
        pose_change(scene, scene.index('m::a'), ASKED, lookup_from_scene, partial(load, path))


def test_a_file_of_the_cache_of_fuel_is_refused(change, tmp_path, monkeypatch):
    cache = tmp_path / 'cache'
    cache.mkdir()
    write_files(cache, m=MODEL)
    (tmp_path / 'm.sdf').symlink_to(cache / 'm.sdf')
    monkeypatch.setenv('GZ_FUEL_CACHE_PATH', str(cache))
    with pytest.raises(PoseNotSetError, match='cache of Gazebo Fuel'):
        change('m::a')


@pytest.mark.parametrize(('name', 'relative_to', 'joint'), [
    ('optical', 'base', 'mount'),
    ('rep103', 'arm', 'mount'),
    # The camera cannot be moved in itself.
    ('optical', 'eye', 'rep103'),
    ('eye', 'base', 'mount'),
    ('arm', '', 'turn'),
])
@pytest.mark.parametrize('is_included', [False, True])
def test_the_origin_of_a_joint_of_urdf_is_set(
        change, tmp_path, name, relative_to, joint, is_included):
    path = tmp_path / 'm.sdf'
    path.write_text(ROBOT)
    write_files(tmp_path, w=world_file('<include><uri>m.sdf</uri></include>'))
    names = [f'r::{each}' if each else '' for each in (name, relative_to)]
    made = change(*names, file='w' if is_included else 'm')
    assert (made.file.path, made.file.undone.new_text) == (str(path), ROBOT.encode())
    assert joint_of(made) == joint


def joint_of(made):
    """Return the name of the joint in which a pose is."""
    return re.findall(rb'<joint name="(\w+)', made.file.before)[-1].decode()


def test_a_urdf_that_is_included_twice(change, tmp_path):
    write_files(tmp_path, m=ROBOT, w=TWICE)
    with pytest.raises(PoseNotSetError, match='also places "y::arm"'):
        change('x::arm', file='w')
    assert joint_of(change(
        'x::arm', 'x::base', file='w', all_instances=True)) == 'turn'


def test_xacro_in_a_comment_of_a_urdf(change, tmp_path):
    write_files(tmp_path, m=ROBOT.replace('</robot>', '<!-- <xacro:include/> --></robot>'))
    assert joint_of(change('r::eye', 'r::arm')) == 'mount'


@pytest.mark.parametrize(('old', 'new'), [
    ('<robot name="r">', '<robot xmlns:xacro="x" name="r"><xacro:property name="p" value="1"/>'),
    (' rpy="0 0.3 0"/>', ' quat_xyzw="0 0.3 0 1"/>')])
def test_the_origin_that_a_file_of_xacro_needs_is_named(change, tmp_path, old, new):
    assert old in ROBOT
    write_files(tmp_path, m=ROBOT.replace(old, new))
    with pytest.raises(PoseNotSetError, match='joint "mount": <origin ') as caught:
        change('r::eye', 'r::arm')
    assert 'xyz="0.5 -1 2"' in caught.value.message


@pytest.mark.parametrize(('old', 'new', 'name', 'joint'), [
    # A joint that moves is not set in place of another one.
    ('"mount" type="fixed"', '"mount" type="continuous"', 'optical', 'rep103'),
    ('"rep103" type="fixed"', '"rep103" type="continuous"', 'optical', 'rep103'),
    ('"turn" type="continuous"', '"turn" type="fixed"', 'eye', 'mount'),
    # The name is that in the file.
    ('"mount"', '"eye"', 'eye_joint', 'eye'),
    # The pose of the robot places the link "world", too.
    ('name="r">', f'name="r">{urdf_texts.origin("0 0 7")}', 'arm', 'turn'),
])
def test_joint_that_can_place_a_link(change, tmp_path, old, new, name, joint):
    robot = ROBOT if '7' not in new else ROBOT.replace('"base"', '"world"')
    write_files(tmp_path, m=robot.replace(old, new))
    assert joint_of(change(f'r::{name}')) == joint


ARM = model_file("""
    <link name="base"/>
    <link name="tool"><pose>1 0 0 0 0 0</pose><sensor name="eye" type="camera"/></link>
    <joint name="turn" type="revolute"><pose relative_to="base"/>
      <parent>base</parent>
      <child>tool</child>
      <axis><xyz>0 0 1</xyz></axis>
    </joint>
    <frame name="mark"><pose>2 0 0 0 0 0</pose></frame>
    <frame name="on_mark"><pose relative_to="mark">0 0 1 0 0 0</pose></frame>""")


@pytest.fixture(name='write_change')
def make_written_change(tmp_path):
    """Changes a pose of the arm; returns the frames that moved, and the text of the file then."""
    path = tmp_path / 'arm.sdf'
    path.write_text(ARM, encoding='utf-8')
    request = LoadRequest(
        str(path), '', tf_options=TfOptions(use_joint_states=True, frame_prefix='r/'))
    loaded = loaded_scene_from_request(request)
    fingerprint = fingerprint_of_scene(loaded.scene)

    def write_change(
            frame, pose, reference='', position=0.0, published=fingerprint, *, dry_run=False):
        positions = loaded.joint_positions
        positions.update(positions.selection(['turn']), np.array([position]))
        found = write_frame_change(
            request, published, frame, pose, reference, positions, dry_run=dry_run)
        return found.moved_frames, path.read_text(encoding='utf-8')

    return write_change


def test_a_pose_is_taken_where_its_reference_has_moved_to(write_change):
    arguments = 'r/mark', Pose(0.5), 'r/tool', np.pi / 2
    assert write_change(*arguments, dry_run=True) == (['r/on_mark'], ARM)
    moved, text = write_change(*arguments)
    assert moved == ['r/on_mark']
    assert_close(load_text(text).pose('m::mark')[:3], (0.0, 1.5, 0.0))


def test_the_camera_of_an_optical_frame_is_moved(write_change):
    moved, text = write_change('r/tool/eye_optical', Pose(0.5))
    assert moved == []
    assert_close(load_text(text).pose('m::tool::eye')[:3], (0.5, 0.0, 0.0))


def test_a_frame_does_not_move_in_one_that_moves_with_it(write_change):
    with pytest.raises(SdfError, match='m::tool'):
        write_change('tool', Pose(0.5), 'r/tool/eye_optical')


def test_a_file_that_is_not_what_is_published(write_change):
    with pytest.raises(SdfError, match='the file has changed since it was read'):
        write_change('mark', Pose(), published=b'other')


TURNING_ROBOT = urdf_texts.robot(
    ''.join(map(urdf_texts.link, ('base', 'arm', 'tool')))
    + urdf_texts.joint('turn', 'base', 'arm', 'continuous', '<axis xyz="0 0 1"/>')
    + urdf_texts.joint('mount', 'arm', 'tool', 'fixed', urdf_texts.origin('1 0 0')))


@pytest.mark.parametrize(('frame', 'asked', 'origin', 'moved'), [
    ('tool', Pose(0.0, 2.0, 0.0, 0.0, 0.0, 0.5 ** 0.5, 0.5 ** 0.5), '2 0 0', []),
    # The joint itself has turned.
    ('arm', Pose(0.5, 0.0, 0.0, 0.0, 0.0, 0.5 ** 0.5, 0.5 ** 0.5), '0.5 0 0', ['tool'])])
def test_the_origin_of_a_urdf_whose_joint_has_turned(tmp_path, frame, asked, origin, moved):
    path = tmp_path / 'robot.urdf'
    path.write_text(TURNING_ROBOT)
    request = LoadRequest(str(path), '', tf_options=TfOptions(use_joint_states=True, kinds=None))
    loaded = loaded_scene_from_request(request)
    positions = loaded.joint_positions
    positions.update(positions.selection(['turn']), np.array([np.pi / 2]))
    found = write_frame_change(
        request, fingerprint_of_scene(loaded.scene), frame, asked, 'base', positions,
        dry_run=False)
    assert found.moved_frames == moved
    written = f'<origin xyz="{origin}" rpy="0 0 0"/>'
    assert path.read_text() == (
        TURNING_ROBOT.replace('<origin xyz="1 0 0" rpy="0 0 0"/>', written) if frame == 'tool' else
        TURNING_ROBOT.replace('"continuous">', f'"continuous">{written}'))
