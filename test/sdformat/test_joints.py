# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What only joints have: type, ends, axes and pitch."""

import math

import pytest
from sdf_texts import codes_of, joint, model_file, only_error, TWO_LINKS, world_file

from sdf_pose_bridge import load_text

ENDS = '<parent>a</parent><child>b</child>'


def joint_with(content='', joint_type='revolute', frame='', version='1.11', **options):
    """Load a joint, which may refer to a frame."""
    loaded, = load_text(model_file(
        TWO_LINKS + frame + joint(ENDS + content, joint_type=joint_type), version=version),
        **options).joints
    return loaded


@pytest.mark.parametrize('joint_type', ['', ' ', 'glue', 'hinge', 'fix ed'])
def test_joint_of_an_unknown_type_is_refused(joint_type):
    assert codes_of(model_file(TWO_LINKS + joint(ENDS, joint_type=joint_type))) == [
        'ATTRIBUTE_INVALID']


@pytest.mark.parametrize('joint_type', [
    'ball', 'continuous', 'fixed', 'gearbox', 'prismatic', 'revolute', 'revolute2', 'screw',
    'universal', 'FIXED', ' fixed ',
])
def test_joint_has_a_type(joint_type):
    assert joint_with('', joint_type).type == joint_type.strip().lower()


@pytest.mark.parametrize(('content', 'joint_type', 'code'), [
    ('<parent>a</parent>', 'fixed', 'ELEMENT_MISSING'),
    ('<child>a</child>', 'revolute', 'ELEMENT_MISSING'),
    ('<parent>a</parent>', 'ball', 'JOINT_CHILD_LINK_INVALID'),
    ('<child>a</child>', 'ball', 'JOINT_PARENT_LINK_INVALID'),
    ('<parent/><child>a</child>', 'fixed', 'ELEMENT_INVALID'),
    ('<parent>a</parent><child> </child>', 'fixed', 'ELEMENT_INVALID'),
])
def test_joint_without_an_end_is_refused(content, joint_type, code):
    assert codes_of(model_file(TWO_LINKS + joint(content, joint_type=joint_type))) == [code]


STATE = '<state world_name="w">{}</state>'
INSERTION = STATE.format('<insertions><model name="m">{}</model></insertions>')


@pytest.mark.parametrize(('place', 'content', 'missing'), [
    (STATE.format('<model name="m">{}</model>'), '<joint name="j"/>', 'angle'),
    (INSERTION, '<joint name="j" type="fixed"><child>x</child></joint>', 'parent'),
    ('<actor name="a">{}</actor>', '<joint name="j" type="fixed"><parent>x</parent></joint>',
     'child'),
    ('<actor name="a">{}</actor>', '<joint name="j" type="fixed"><child>x</child></joint>',
     'parent'),
])
def test_joint_without_a_frame_must_have_its_parts(place, content, missing):
    error = only_error(world_file(place.format(content)))
    assert error.code == 'ELEMENT_MISSING'
    assert f'the joint has no <{missing}>' in error.message


def test_ball_joint_without_a_frame_may_have_no_ends():
    load_text(world_file(INSERTION.format('<joint name="j" type="ball"/>')))


def test_joint_without_both_ends_has_two_errors():
    assert codes_of(model_file(TWO_LINKS + joint(''))) == ['ELEMENT_MISSING'] * 2


def test_ends_of_a_joint_are_stripped():
    content = '<parent>\n a </parent><child><!-- c --> b</child>'
    scene = load_text(model_file(TWO_LINKS + joint(content)))
    assert [scene.names[index] for index in scene.joints[0][2:4]] == ['m::a', 'm::b']


# Axes

def axes_of(content, frame='', version='1.11'):
    """Load a joint with these axes in a frame that is rotated."""
    pose = '<pose degrees="true">0 0 0 90 0 0</pose>'
    return joint_with(pose + content, 'universal', frame, version).axes


@pytest.mark.parametrize('xyz', ['0 0 0', '', '1 0', 'a b c'])
def test_wrong_axis_is_refused(xyz):
    axis = f'<axis><xyz>{xyz}</xyz></axis>'
    assert codes_of(model_file(TWO_LINKS + joint(ENDS + axis))) == ['ELEMENT_INVALID']


@pytest.mark.parametrize(('content', 'xyz'), [
    ('', (0, 0, 1)), ('<axis><xyz>0 -2 0</xyz></axis>', (0, -1, 0)),
    ('<axis><xyz expressed_in="j">0 0 3</xyz></axis>', (0, 0, 1)),
    ('<axis><xyz expressed_in="__model__">0 0 3</xyz></axis>', (0, 1, 0)),
    ('<axis><xyz expressed_in="f">1 0 0</xyz></axis>', (0, 0, -1)),
])
def test_axis_is_a_unit_vector_in_the_joint(content, xyz):
    frame = '<frame name="f"><pose degrees="true">0 0 0 0 0 90</pose></frame>'
    assert axes_of(content, frame)[0].xyz == pytest.approx(xyz, abs=1e-15)


def test_axis_of_an_old_file_can_be_in_the_model_frame():
    content = '<axis><xyz>0 0 1</xyz><use_parent_model_frame>1</use_parent_model_frame></axis>'
    assert axes_of(content, version='1.6')[0].xyz == pytest.approx((0, 1, 0), abs=1e-15)


def test_axes_have_limits_of_their_own():
    limit = '<limit><lower>-1</lower><upper>{}</upper></limit>'
    axes = axes_of(
        f'<axis><xyz>1 0 0</xyz>{limit.format(2)}</axis>'
        f'<axis2><xyz>0 1 0</xyz>{limit.format("inf")}</axis2>')
    assert [(axis.lower, axis.upper) for axis in axes] == [(-1.0, 2.0), (-1.0, math.inf)]


def test_axis_without_limits():
    axis, _ = axes_of('<axis><xyz>1 0 0</xyz><limit/></axis>')
    assert (axis.lower, axis.upper, axis.mimic) == (-math.inf, math.inf, None)


@pytest.mark.parametrize(('content', 'pitch_m'), [
    ('', 1.0),
    ('<screw_thread_pitch>0.5</screw_thread_pitch>', 0.5),
    ('<thread_pitch>-3.141592653589793</thread_pitch>', 2.0),
    ('<thread_pitch>1</thread_pitch><screw_thread_pitch>0.5</screw_thread_pitch>', 0.5),
    ('<thread_pitch>0</thread_pitch>', 0.0),
])
def test_pitch_of_a_screw_joint(content, pitch_m):
    assert joint_with(content, 'screw').screw_pitch_m == pytest.approx(pitch_m)


def dynamics_of(content, **options):
    axis, _ = joint_with(f'<axis>{content}</axis>', **options).axes
    return axis.effort, axis.velocity, axis.damping, axis.friction


@pytest.mark.parametrize(('content', 'dynamics'), [
    ('', (math.inf, math.inf, 0, 0)),
    ('<limit/>', (math.inf, math.inf, 0, 0)),
    ('<limit><effort>-1</effort><velocity>-1</velocity></limit>', (math.inf, math.inf, 0, 0)),
    (('<limit><effort>0</effort><velocity>2</velocity></limit>'
      '<dynamics><damping>.1</damping><friction>.2</friction></dynamics>'), (0, 2, 0.1, 0.2)),
])
def test_axis_has_dynamics(content, dynamics):
    assert dynamics_of(content, shapes=True) == dynamics


def test_dynamics_are_not_read_unless_they_are_asked_for():
    content = '<dynamics><damping>.1</damping></dynamics>'
    assert dynamics_of(content) == (math.inf, math.inf, 0, 0)


# Limits that may be degrees

@pytest.mark.parametrize(('joint_type', 'limits', 'is_warned'), [
    ('revolute', (-180, 180), True), ('revolute', (0, 90), True), ('universal', (-45, 45), True),
    ('revolute', (-12.5, 12.5), False), ('revolute', (-25, 25), False),
    ('revolute', (-1e16, 1e16), False), ('prismatic', (0, 90), False)])
def test_limits_in_degrees_are_a_warning(joint_type, limits, is_warned):
    lower, upper = limits
    axis = f'<axis><limit><lower>{lower}</lower><upper>{upper}</upper></limit></axis>'
    scene = load_text(model_file(TWO_LINKS + joint(ENDS + axis, joint_type=joint_type)))
    assert [w.message for w in scene.warnings] == is_warned * [
        f'the limits {lower:g} to {upper:g} of joint "j" are radians; they look like degrees']
