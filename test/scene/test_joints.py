# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Joints join two bodies: every rule, at every level of nesting."""

import pytest
from sdf_texts import codes_of
from sdf_texts import errors_of
from sdf_texts import fixed_joint
from sdf_texts import model_file
from sdf_texts import names_of
from sdf_texts import only_error
from sdf_texts import TWO_LINKS
from sdf_texts import world_file

import sdf_pose_bridge

FRAMES = ('<frame name="on_a" attached_to="a"/><frame name="also_on_a" attached_to="on_a"/>'
          '<model name="n"><link name="k"/></model>')


def in_top_model(joint):
    return model_file(TWO_LINKS + FRAMES + joint)


def in_model_of_world(joint):
    return world_file(f'<model name="m">{TWO_LINKS}{FRAMES}{joint}</model>')


def in_nested_model(joint):
    return model_file(
        f'<link name="l"/><model name="n1"><model name="n2">{TWO_LINKS}{FRAMES}{joint}</model>'
        '</model>')


def in_world(joint):
    models = ''.join(f'<model name="{name}"><link name="l"/></model>' for name in 'ab')
    return world_file(
        models + '<frame name="on_a" attached_to="a::l"/>'
        '<frame name="also_on_a" attached_to="on_a"/>'
        '<model name="n"><link name="k"/></model>' + joint)


everywhere = pytest.mark.parametrize(
    'place', [in_top_model, in_model_of_world, in_nested_model, in_world])


@everywhere
def test_the_child_is_unknown(place):
    error = only_error(place(fixed_joint('j', 'a', 'zzz')))
    assert error.code == 'JOINT_CHILD_LINK_INVALID'
    assert '"zzz"' in error.message


@everywhere
def test_the_child_is_the_world(place):
    error = only_error(place(fixed_joint('j', 'a', 'world')))
    assert error.code == 'JOINT_CHILD_LINK_INVALID'
    assert 'only its parent' in error.message


@everywhere
def test_the_child_is_the_joint(place):
    assert codes_of(place(fixed_joint('j', 'a', 'j')))[0] == 'FRAME_ATTACHED_TO_CYCLE'


@everywhere
def test_the_parent_is_unknown(place):
    error = only_error(place(fixed_joint('j', 'zzz', 'a')))
    assert error.code == 'JOINT_PARENT_LINK_INVALID'
    assert '"zzz"' in error.message


@everywhere
def test_the_parent_is_the_joint(place):
    assert codes_of(place(fixed_joint('j', 'j', 'a'))) == ['JOINT_PARENT_LINK_INVALID']


@everywhere
@pytest.mark.parametrize('ends', [
    ('a', 'a'), ('a', 'on_a'), ('on_a', 'a'), ('on_a', 'also_on_a'), ('on_a', 'on_a'),
    ('n', 'n::k'),
])
def test_both_ends_are_one_body(place, ends):
    assert codes_of(place(fixed_joint('j', *ends))) == ['JOINT_PARENT_SAME_AS_CHILD']


@everywhere
def test_an_axis_is_expressed_in_an_unknown_frame(place):
    axis = '<axis><xyz expressed_in="zzz">1 0 0</xyz></axis>'
    error = only_error(place(fixed_joint('j', 'a', 'b', axis)))
    assert error.code == 'JOINT_AXIS_EXPRESSED_IN_INVALID'
    assert '"zzz"' in error.message


def test_the_second_axis_is_checked_too():
    axis = ('<axis><xyz expressed_in="a">1 0 0</xyz></axis>'
            '<axis2><xyz expressed_in="zzz">1 0 0</xyz></axis2>')
    assert codes_of(in_top_model(fixed_joint('j', 'a', 'b', axis))) == [
        'JOINT_AXIS_EXPRESSED_IN_INVALID']


@pytest.mark.parametrize('name', ['__model__', 'a', 'j', 'n::k', 'on_a', '', ' '])
def test_an_axis_may_be_expressed_in_any_frame_of_the_scope(name):
    axis = f'<axis><xyz expressed_in="{name}">1 0 0</xyz></axis>'
    sdf_pose_bridge.load_text(in_top_model(fixed_joint('j', 'a', 'b', axis)))


def test_an_axis_moves_no_frame():
    axis = '<axis><xyz expressed_in="a">0 1 0</xyz></axis>'
    scene = sdf_pose_bridge.load_text(in_top_model(fixed_joint('j', 'a', 'b', axis)))
    assert scene.pose('m::j') == (0, 0, 0, 0, 0, 0, 1)


@everywhere
@pytest.mark.parametrize('ends', [
    ('a', 'b'), ('world', 'a'), ('on_a', 'b'), ('b', 'also_on_a'), ('a', 'n'), ('n::k', 'b'),
    ('n::__model__', 'b'), ('world', 'n::__model__'),
])
def test_two_bodies_are_joined(place, ends):
    scene = sdf_pose_bridge.load_text(place(fixed_joint('j', *ends)))
    assert any(name.endswith('j') for name in names_of(scene))


@pytest.mark.parametrize('ends', [('__model__', 'b'), ('b', '__model__')])
def test_a_joint_may_hold_the_model_frame(ends):
    sdf_pose_bridge.load_text(in_top_model(fixed_joint('j', *ends)))


def test_a_joint_may_hold_another_joint():
    sdf_pose_bridge.load_text(in_top_model(
        fixed_joint('j', 'a', 'b') + fixed_joint('k', 'j', 'n')))


def test_a_frame_of_the_world_is_no_child():
    text = world_file(
        '<model name="a"><link name="l"/></model><frame name="f"/>' + fixed_joint('j', 'a', 'f'))
    assert codes_of(text) == ['JOINT_CHILD_LINK_INVALID']


def test_a_frame_of_the_world_may_be_the_parent():
    sdf_pose_bridge.load_text(world_file(
        '<model name="a"><link name="l"/></model><frame name="f"/>' + fixed_joint('j', 'f', 'a')))


def test_a_static_model_may_be_the_child():
    sdf_pose_bridge.load_text(world_file(
        '<model name="a"><link name="l"/></model>'
        '<model name="s"><static>1</static><link name="l"/></model>' + fixed_joint('j', 'a', 's')))


def test_names_of_other_scopes_are_unknown():
    text = model_file(TWO_LINKS + '<model name="n"><link name="k"/>' + fixed_joint('j', 'a', 'k')
                      + '</model>')
    assert codes_of(text) == ['JOINT_PARENT_LINK_INVALID']


def test_the_lines_of_both_ends_are_told():
    text = model_file(
        '<link name="a"/>\n<joint name="j" type="fixed">\n<parent>y</parent>\n<child>z</child>'
        '</joint>')
    assert {(error.code, error.line) for error in errors_of(text)} == {
        ('JOINT_PARENT_LINK_INVALID', 3), ('JOINT_CHILD_LINK_INVALID', 4)}


def test_the_element_is_told():
    error = only_error(in_nested_model(fixed_joint('j', 'zzz', 'a')))
    assert error.element == (
        '/sdf/model[@name="m"]/model[@name="n1"]/model[@name="n2"]/joint[@name="j"]/parent')


def test_a_joint_without_ends_is_not_told_of_again():
    joint = '<joint name="j" type="fixed"><parent>a</parent></joint>'
    assert codes_of(in_top_model(joint)) == ['ELEMENT_MISSING']
