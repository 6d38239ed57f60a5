# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Poses in the root: chains of references, and placement frames."""

from dataclasses import fields

from matrices import assert_close
import numpy as np
import pytest
from sdf_texts import (
    assert_at,
    joint,
    LINK,
    model_file,
    only_error,
    posed,
    TWO_LINKS,
    world_file,
    write_files,
)

from sdf_pose_bridge import load_text


def test_quaternions_have_unit_length_at_the_end_of_long_chains():
    frames = ''.join(
        f'<frame name="f{i}" attached_to="f{i - 1}">'
        f'<pose degrees="true">0.5 -0.25 1 {20 * i} -34 50</pose></frame>'
        for i in range(2000))
    scene = load_text(model_file('<link name="f-1"/>' + frames))
    norms = np.linalg.norm(scene.poses[:, 3:], axis=1)
    assert_close(norms, 1.0, 1e-15)
    assert (scene.poses[:, 6] >= 0.0).all()


def test_poses_have_no_negative_zeros():
    scene = load_text(model_file("""
        <link name="a"><pose>-0 -0 -0 0 0 3.141592653589793</pose></link>
        <link name="b"><pose relative_to="a">-0 0 0 0 0 3.141592653589793</pose></link>"""))
    assert not (np.signbit(scene.poses) & (scene.poses == 0.0)).any()


@pytest.mark.filterwarnings('error')
@pytest.mark.parametrize(('content', 'tag'), [
    (posed('frame', 'a', '1e299 0 0 0 0 0') + posed('frame', 'b', '1.7e308 0 0 0 0 0', 'a'),
     'frame[@name="b"]/pose'),
    (posed('frame', 'a', '9e307 0 0 0 0 0') + posed('frame', 'b', '1.7e308 0 0 0 0 0', 'a'),
     'frame[@name="a"]/pose'),
    ('<model name="n"><pose>0 0 -1e301 0 0 0</pose><link name="k"/></model>',
     'model[@name="n"]/pose'),
])
def test_poses_that_add_up_to_more_than_numbers_hold_are_errors(content, tag):
    error = only_error(model_file(f'<link name="l"/>{content}'))
    assert (error.code, error.place.element) == (
        'ELEMENT_INVALID', f'/sdf/model[@name="m"]/{tag}')


@pytest.mark.filterwarnings('error')
@pytest.mark.parametrize('size', ['1 1 1e200', '1e120 1e120 1e120'])
def test_automatic_inertial_that_is_too_large_is_an_error(size):
    error = only_error(model_file(
        '<link name="l"><inertial auto="true"/><collision name="c"><geometry><box>'
        f'<size>{size}</size></box></geometry></collision></link>'))
    assert error.code in ('LINK_INERTIA_INVALID', 'ELEMENT_INVALID')


def test_elements_that_are_left_out_change_nothing_else(tmp_path):
    write_files(tmp_path, leaf=model_file(LINK))
    mimic = '<axis><xyz>0 0 1</xyz><mimic joint="{}"/></axis>'
    box = '<geometry><box><size>1 2 3</size></box></geometry>'
    text = world_file(
        '{}<include><uri>leaf.sdf</uri><name>i</name></include>'
        f'<model name="m" placement_frame="f">{TWO_LINKS}<link name="c">'
        f'<inertial auto="true"/><collision name="c">{box}</collision>'
        f'<visual name="v">{box}</visual>'
        '<sensor name="s" type="camera"><camera/></sensor></link><plugin name="p" filename="p"/>'
        + posed('frame', 'f', '1 0 0 0 0 0', 'b')
        + joint('<parent>a</parent><child>b</child><axis><xyz>1 0 0</xyz></axis>', 'j', 'revolute')
        + joint(f'<parent>b</parent><child>c</child>{mimic.format("j")}', 'k', 'revolute')
        + f'<model name="n"><static>1</static>{TWO_LINKS}</model><model name="o">{TWO_LINKS}'
        + joint(f'<parent>a</parent><child>b</child>{mimic.format("zzz")}', 'l', 'revolute')
        + '</model></model>', version='1.11').replace('</sdf>', '<world name="v"/></sdf>')
    ghost = posed('light', 'ghost', '1e301 0 0 0 0 0', 'zzz')
    plain, scene = (
        load_text(text.format(first), str(tmp_path / 'main.sdf'), shapes=True, plugins=True)
        for first in ('', ghost))
    assert [axis.mimic is not None for joint in scene.joints for axis in joint.axes[:1]] == [
        False, True, False]
    assert [*scene.world_names.values()] == ['w', 'v']
    assert scene.bodies[scene.index('m::c::v')] == -1
    assert [*scene.placements] == [scene.index('m')]
    for name in [each.name for each in fields(scene) if each.name != 'warnings']:
        found, expected = getattr(scene, name), getattr(plain, name)
        is_array = isinstance(found, np.ndarray)
        assert np.array_equal(found, expected) if is_array else found == expected, name


# Placement frames

PLACED = """
    <pose>1 2 3 0 0 1.5707963267948966</pose>
    <link name="l"><pose>1 0 0 0 0 0</pose></link>
    <link name="k"><pose>0 0 4 0 0 0</pose></link>
    <joint name="j" type="fixed">
      <parent>l</parent>
      <child>k</child>
      <pose>1 1 1 0 0 0</pose>
    </joint>
    <frame name="f" attached_to="l"><pose>0 1 0 0 0 0</pose></frame>
    <model name="n"><pose>0 0 1 0 0 0</pose>
      <link name="b"><pose>0 1 0 0 0 0</pose></link>
    </model>"""


@pytest.mark.parametrize(
    'frame', ['l', 'k', 'j', 'f', 'n', 'n::b', 'n::__model__', '__model__', '', ' '])
def test_pose_of_a_model_is_that_of_its_placement_frame(frame):
    scene = load_text(model_file(PLACED, attributes=f'placement_frame="{frame}"'))
    name = f'm::{frame.strip() or "__model__"}'.removesuffix('::__model__')
    assert_at(scene, name, (1, 2, 3, 0, 0, 0.5 ** 0.5, 0.5 ** 0.5))


def test_placement_frame_of_a_static_model():
    scene = load_text(world_file(
        '<model name="m" placement_frame="f"><static>1</static><pose>1 0 0 0 0 0</pose>'
        + posed('frame', 'f', '0 1 0 0 0 0') + '</model>'))
    assert_at(scene, 'm', (1, -1, 0))


def test_placement_frame_in_a_model_with_a_placement_frame():
    inner = """
        <model name="i" placement_frame="f"><pose>0 1 0 0 0 1</pose>
          <link name="l"/>
          <frame name="g"><pose>1 0 0 0 0 0.5</pose></frame>
          <frame name="f"><pose relative_to="g">0 2 0 0 0 0</pose></frame>
        </model>"""
    scene = load_text(model_file(
        '<pose>3 4 0 0 0 2</pose><link name="l"/>' + inner, attributes='placement_frame="i::f"'))
    assert_at(scene, 'm::i::f', (3, 4, 0))
    assert scene.pose('m::i::f', 'm')[:3] == pytest.approx((0.0, 1.0, 0.0), abs=1e-12)
    assert scene.pose('m::i::f', 'm::i::g')[:3] == pytest.approx((0.0, 2.0, 0.0))
