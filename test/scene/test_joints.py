# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Joints join two bodies: every rule, at every depth of nesting."""

import pytest
from sdf_texts import (
    codes_of,
    errors_of,
    fixed_joint,
    model_file,
    only_error,
    TWO_LINKS,
    world_file,
)

from sdf_pose_bridge import load_text

FRAMES = ('<frame name="on_a" attached_to="a"/><model name="n"><link name="k"/></model>'
          '<frame name="also_on_a" attached_to="on_a"><pose>0 0 0 0 0 1</pose></frame>')


def in_top_model(joint):
    return model_file(TWO_LINKS + joint + FRAMES)


def in_model_of_world(joint):
    return world_file(f'<model name="m">{TWO_LINKS}{joint}{FRAMES}</model>')


def in_nested_model(joint):
    return model_file(
        f'<link name="l"/><model name="n1"><model name="n2">{TWO_LINKS}{joint}{FRAMES}</model>'
        '</model>')


def in_world(joint):
    models = ''.join(f'<model name="{name}"><link name="l"/></model>' for name in 'ab')
    return world_file(models + joint + FRAMES)


at_every_depth = pytest.mark.parametrize(
    'file_with', [in_top_model, in_model_of_world, in_nested_model, in_world])
where_libsdformat_checks = pytest.mark.parametrize(
    'file_with', [in_top_model, in_model_of_world, in_world])


def axis_in(frame, tag='axis'):
    return f'<{tag}><xyz expressed_in="{frame}">1 0 0</xyz></{tag}>'


@pytest.mark.parametrize(('ends', 'code'), [
    (('base', '::a'), 'JOINT_CHILD_LINK_INVALID'), (('::a', 'base'), 'JOINT_PARENT_LINK_INVALID')])
def test_end_that_begins_with_two_colons_is_not_found(ends, code):
    links = '<link name="base"/><link name="::a"/>'
    error = only_error(model_file(links + fixed_joint('j', *ends), version='1.6'))
    assert error.code == code
    # Not the name itself as the nearest one.
    assert str(error).endswith('; a joint finds no name that begins with "::"')


@at_every_depth
@pytest.mark.parametrize(('child', 'code', 'words'), [
    ('zzz', 'JOINT_CHILD_LINK_INVALID', '"zzz"'),
    ('world', 'JOINT_CHILD_LINK_INVALID', 'only its parent'),
    ('j', 'FRAME_ATTACHED_TO_CYCLE', ''),
])
def test_wrong_child_is_refused(file_with, child, code, words):
    error = only_error(file_with(fixed_joint('j', 'a', child)))
    assert error.code == code
    assert words in error.message


@where_libsdformat_checks
@pytest.mark.parametrize(('ends', 'content', 'code'), [
    (('zzz', 'a'), '', 'JOINT_PARENT_LINK_INVALID'),
    (('j', 'a'), '', 'JOINT_PARENT_LINK_INVALID'),
    (('no::__model__', 'b'), '', 'FRAME_ATTACHED_TO_INVALID'),
    *((ends, '', 'JOINT_PARENT_SAME_AS_CHILD') for ends in (
        ('a', 'a'), ('a', 'on_a'), ('on_a', 'a'), ('on_a', 'also_on_a'), ('on_a', 'on_a'),
        ('n', 'n::k'))),
    (('a', 'b'), axis_in('zzz'), 'JOINT_AXIS_EXPRESSED_IN_INVALID'),
    (('a', 'b'), axis_in('a') + axis_in('zzz', 'axis2'), 'JOINT_AXIS_EXPRESSED_IN_INVALID'),
])
def test_wrong_parent_or_axis_is_refused(file_with, ends, content, code):
    error = only_error(file_with(fixed_joint('j', *ends, content)))
    assert error.code == code
    assert 'zzz' not in (*ends, content) or '"zzz"' in error.message
    assert error.element.endswith('/axis2') is ('axis2' in content)


@pytest.mark.parametrize('name', ['__model__', 'a', 'j', 'n::k', 'on_a', '', ' '])
def test_axis_can_be_in_any_frame_of_the_scope(name):
    axis = f'<axis><xyz expressed_in="{name}">1 0 0</xyz></axis>'
    scene = load_text(in_top_model(fixed_joint('j', 'a', 'b', axis)))
    assert scene.pose('m::j') == (0, 0, 0, 0, 0, 0, 1)
    assert scene.joints[0].axes[0].expressed_in.name == ''


def following(joint, axis='axis', name='k'):
    """Write a joint that mimics another one."""
    mimic = f'<axis><xyz>1 0 0</xyz><mimic joint="{joint}" axis="{axis}"/></axis>'
    return fixed_joint(name, 'b', 'n', mimic)


@where_libsdformat_checks
@pytest.mark.parametrize(('joint', 'axis', 'words'), [
    ('zzz', 'axis', 'names no joint'), ('', 'axis', 'names no joint'),
    ('a', 'axis', 'names no joint'), ('j', 'axis2', 'has no <axis2>'),
])
def test_axis_that_mimics_nothing_is_refused(file_with, joint, axis, words):
    leader = fixed_joint('j', 'a', 'b', '<axis><xyz>1 0 0</xyz></axis>')
    error = errors_of(file_with(leader + following(joint, axis)))[-1]
    assert error.code == 'JOINT_AXIS_MIMIC_INVALID'
    assert words in error.message
    assert '/axis2' not in error.element


@at_every_depth
@pytest.mark.parametrize(('joint', 'axis', 'words'), [
    ('k', 'axis', 'cannot mimic itself'), ('j', 'axis3', 'must be one of axis, axis2')])
def test_axis_of_the_leader_is_checked_at_every_depth(file_with, joint, axis, words):
    leader = fixed_joint('j', 'a', 'b', '<axis><xyz>1 0 0</xyz></axis>')
    error = only_error(file_with(leader + following(joint, axis)))
    assert error.code == 'JOINT_AXIS_MIMIC_INVALID'
    assert words in error.message


@where_libsdformat_checks
def test_axis_can_mimic_another_one(file_with):
    leader = fixed_joint('j', 'a', 'b', '<axis><xyz>1 0 0</xyz></axis>')
    text = file_with(leader + following('j')).replace('version="1.9"', 'version="1.11"')
    scene = load_text(text.replace('version="1.10"', 'version="1.11"'))
    leading, follower = scene.joints
    assert follower.axes[0].mimic[1:] == (0, 1.0, 0.0, 0.0, leading.element)


LEADER = '<link name="k"/>' + fixed_joint('j', 'world', 'k', '<axis><xyz>1 0 0</xyz></axis>')


@pytest.mark.parametrize(('content', 'leader', 'is_found'), [
    (f'<model name="n">{LEADER}</model>', 'n::j', True),
    (f'<model name="n::o">{LEADER}</model>', 'n::o::j', False),
    (LEADER.replace('"j"', '"n::j"'), 'n::j', True),
])
def test_leader_in_a_model_whose_name_holds_the_separator_is_not_found(content, leader, is_found):
    follower = fixed_joint(
        'i', 'world', 'a', f'<axis><xyz>1 0 0</xyz><mimic joint="{leader}"/></axis>')
    text = model_file(f'<link name="a"/>{content}{follower}', version='1.6')
    if is_found:
        assert load_text(text).joints[-1].axes[0].mimic is not None
    else:
        assert codes_of(text) == ['JOINT_AXIS_MIMIC_INVALID']


def ends_of_joints(text):
    """Return the names of the frames that each joint joins, without scopes: parent, child."""
    scene = load_text(text)
    return [tuple('world' if scene.parents[end] < 0 else scene.own_name(end)
                  for end in (joint.parent, joint.child)) for joint in scene.joints]


@at_every_depth
@pytest.mark.parametrize(('parent', 'child', 'found'), [
    ('a', 'b', ('a', 'b')), ('world', 'a', ('world', 'a')), ('on_a', 'b', ('on_a', 'b')),
    ('b', 'also_on_a', ('b', 'also_on_a')), ('a', 'n', ('a', 'n')), ('n::k', 'b', ('k', 'b')),
    ('n::__model__', 'b', ('n', 'b')), ('world', 'n::__model__', ('world', 'n')),
])
def test_parent_and_child_on_two_bodies(file_with, parent, child, found):
    assert ends_of_joints(file_with(fixed_joint('j', parent, child))) == [found]


A_AND = '<model name="a"><link name="l"/></model>{}'
STATIC = '<model name="s"><static>1</static><link name="l"/></model>'


@pytest.mark.parametrize(('text', 'found'), [
    (in_top_model(fixed_joint('j', '__model__', 'b')), [('m', 'b')]),
    (in_top_model(fixed_joint('j', 'b', '__model__')), [('b', 'm')]),
    (in_top_model(fixed_joint('j', 'a', 'b') + fixed_joint('k', 'j', 'n')),
     [('a', 'b'), ('j', 'n')]),
    (world_file(A_AND.format('<frame name="f"/>') + fixed_joint('j', 'f', 'a')), [('f', 'a')]),
    (world_file(A_AND.format(STATIC) + fixed_joint('j', 'a', 's')), [('a', 's')]),
])
def test_ends_that_are_no_links(text, found):
    assert ends_of_joints(text) == found


@pytest.mark.parametrize(('parent', 'code'), [
    ('a', 'JOINT_CHILD_LINK_INVALID'), ('world', 'JOINT_PARENT_SAME_AS_CHILD')])
def test_frame_of_the_world_as_the_child_is_refused(parent, code):
    model = '<model name="a"><link name="l"/></model><frame name="f"/>'
    assert codes_of(world_file(model + fixed_joint('j', parent, 'f'))) == [code]


@pytest.mark.parametrize(('joint', 'code'), [
    (fixed_joint('j', 'zzz', 'a'), 'JOINT_PARENT_LINK_INVALID'),
    (fixed_joint('j', 'l', 'a'), 'JOINT_PARENT_LINK_INVALID'),
    (fixed_joint('j', 'j', 'a'), 'JOINT_PARENT_LINK_INVALID'),
    ('<joint name="j" type="ball"><child>a</child></joint>', 'JOINT_PARENT_LINK_INVALID'),
    (fixed_joint('j', 'a', 'on_a'), 'JOINT_PARENT_SAME_AS_CHILD'),
    (fixed_joint('j', 'a', 'b', '<axis><xyz expressed_in="zzz">1 0 0</xyz></axis>'),
     'JOINT_AXIS_EXPRESSED_IN_INVALID'),
    (fixed_joint('j', 'a', 'b', '<axis><xyz>1 0 0</xyz><mimic joint="zzz"/></axis>'),
     'JOINT_AXIS_MIMIC_INVALID'),
])
def test_wrong_joint_of_a_model_in_a_model_gives_a_warning(joint, code):
    scene = load_text(in_nested_model(joint))
    (warning,) = scene.warnings
    assert warning.code == code
    assert warning.message.endswith('; libsdformat does not check this here')
    assert '__default__' not in warning.message
    assert [each.axes[0].xyz for each in scene.joints] == [(1.0, 0.0, 0.0)] * ('axis' in joint)


@pytest.mark.parametrize(('name', 'others'), [('a', []), ('zzz', ['JOINT_CHILD_LINK_INVALID'])])
def test_same_name_at_both_ends_is_refused_in_a_model_in_a_model(name, others):
    assert codes_of(in_nested_model(fixed_joint('j', name, name))) == [
        *others, 'JOINT_PARENT_SAME_AS_CHILD']


def test_errors_have_the_lines_of_both_ends():
    text = model_file(
        '<link name="a"/>\n<joint name="j" type="fixed">\n<parent>y</parent>\n<child>z</child>'
        '</joint>')
    joint = '/sdf/model[@name="m"]/joint[@name="j"]'
    assert [(error.code, error.line, error.element) for error in errors_of(text)] == [
        ('JOINT_PARENT_LINK_INVALID', 3, f'{joint}/parent'),
        ('JOINT_CHILD_LINK_INVALID', 4, f'{joint}/child')]
