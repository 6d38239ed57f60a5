# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The frame graph: unknown names, cycles, default references, and attachment."""

import pytest
from sdf_texts import (
    assert_at,
    codes_of,
    fixed_joint,
    model_file,
    names_of,
    only_error,
    posed,
    warning_codes,
    world_file,
)

from sdf_pose_bridge import Kind, load_text

A = '<link name="a"/>'
B = posed('link', 'b', '1 0 0 0 0 1.5707963267948966')
NESTED = '<model name="n"><pose>0 0 1 0 0 0</pose><link name="k"/></model>'


def name_at(scene, indices, name):
    """Return the name of the element that an array has for another; None for -1."""
    index = int(indices[scene.index(name)])
    return None if index < 0 else scene.names[index]


REFUSED = {
    'POSE_RELATIVE_TO_INVALID': [
        model_file(A + '<model name="n" placement_frame="a"><link name="k"/></model>'),
    ],
    'FRAME_ATTACHED_TO_INVALID': [
        model_file(A + '<frame name="f" attached_to="zzz"/>'),
        model_file(A + '<frame name="f" attached_to="zzz"><pose relative_to="a"/></frame>'),
        model_file(A + '<frame name="f" attached_to="m"/>'),
        world_file('<frame name="f" attached_to="zzz"/>'),
    ],
    'POSE_RELATIVE_TO_CYCLE': [
        model_file(A + posed('frame', 'f', '', 'f')),
        model_file(A + posed('frame', 'f', '', 'g') + posed('frame', 'g', '', 'f')),
        model_file(A + posed('link', 'b', '', 'j') + fixed_joint('j', 'a', 'b')),
        *(model_file(f'{A}<model name="n"><pose relative_to="{name}"/><link name="k"/></model>')
          for name in ('n', 'n::k', 'n::__model__')),
        world_file('<model name="n"><pose relative_to="f"/><link name="k"/></model>'
                   + posed('frame', 'f', '', 'n::k')),
        world_file('<frame name="f"><pose relative_to="f"/></frame>'),
    ],
    'FRAME_ATTACHED_TO_CYCLE': [
        model_file(A + '<frame name="f" attached_to="f"/>'),
        model_file(A + '<frame name="f" attached_to="f"><pose relative_to="a"/></frame>'),
        model_file(A + '<frame name="f" attached_to="g"/><frame name="g" attached_to="f"/>'),
        world_file('<frame name="f" attached_to="g"/><frame name="g" attached_to="f"/>'),
        model_file(A + '<frame name="f"/>', attributes='canonical_link="f"'),
        model_file(A, attributes='canonical_link="__model__"'),
        model_file(A + '<frame name="f" attached_to="j"/>' + fixed_joint('j', 'a', 'f')),
        model_file(A + fixed_joint('j', 'a', 'j')),
    ],
    'MODEL_WITHOUT_LINK': [
        model_file(''), model_file('<frame name="f"/>'), model_file('<static>false</static>'),
        model_file(A + '<model name="n"/>'), world_file('<model name="m"/>'),
        model_file('', attributes='canonical_link="zzz"'),
        model_file('<frame name="f"/>', attributes='canonical_link="f"'),
    ],
}


@pytest.mark.parametrize(('code', 'text'), [
    (code, text) for code, texts in REFUSED.items() for text in texts])
def test_wrong_reference_is_refused_once(code, text):
    assert codes_of(text) == [code]


# Unknown names

@pytest.mark.parametrize('text', [
    model_file(A + posed('link', 'b', '', 'zzz')),
    model_file(A + posed('frame', 'f', '', 'zzz')),
    model_file(A + '<model name="n"><pose relative_to="zzz"/><link name="k"/></model>'),
    model_file(A + B + fixed_joint('j', 'a', 'b', '<pose relative_to="zzz"/>')),
    world_file('<model name="m"><pose relative_to="zzz"/><link name="k"/></model>'),
    world_file(posed('frame', 'f', '', 'zzz')),
    model_file(A, attributes='placement_frame="zzz"'),
])
def test_unknown_reference_of_a_pose_is_refused(text):
    error = only_error(text)
    assert error.code == 'POSE_RELATIVE_TO_INVALID'
    assert '"zzz"' in error.message


def test_unknown_name_gives_no_other_errors():
    text = model_file(
        A + '<frame name="f" attached_to="zzz"/><frame name="g" attached_to="f"/>'
        + posed('link', 'b', '', 'f') + fixed_joint('j', 'a', 'g'))
    assert codes_of(text)[0] == 'FRAME_ATTACHED_TO_INVALID'
    assert 'POSE_RELATIVE_TO_INVALID' not in codes_of(text)


@pytest.mark.parametrize('tag', [
    'visual', 'collision', 'sensor', 'light', 'particle_emitter', 'projector'])
def test_child_of_a_link_with_an_unknown_reference_is_left_out(tag):
    scene = load_text(model_file(
        '<link name="a">' + posed(tag, 'ghost', '1 0 0 0 0 0', 'zzz')
        + posed(tag, 'good', '1 0 0 0 0 0') + '</link>'))
    assert names_of(scene) == ['m', 'm::a', 'm::a::good']
    assert warning_codes(scene) == ['POSE_RELATIVE_TO_INVALID']
    assert '"zzz"' in scene.warnings[0].message


@pytest.mark.parametrize('text', [
    model_file(A + B + fixed_joint('j', 'a', 'b', posed('sensor', 's', '', 'zzz'))),
    world_file(posed('light', 's', '', 'zzz')),
])
def test_sensor_or_light_elsewhere_with_an_unknown_reference_is_left_out(text):
    scene = load_text(text)
    assert not [name for name in scene.names if name.endswith('s')]
    assert warning_codes(scene) == ['POSE_RELATIVE_TO_INVALID']


@pytest.mark.parametrize(('attribute', 'code'), [
    ('placement_frame', 'POSE_RELATIVE_TO_INVALID'),
    ('canonical_link', 'MODEL_CANONICAL_LINK_INVALID')])
@pytest.mark.parametrize('name', ['zzz', 'm', 'm::a', 'world', 'n::zzz', 'k'])
def test_unknown_name_of_a_model_is_refused(attribute, code, name):
    error = only_error(model_file(A + NESTED, attributes=f'{attribute}="{name}"'))
    assert error.code == code
    assert f'"{name}"' in error.message


# Cycles

def test_cycle_is_reported_once_at_its_first_element():
    frames = '\n'.join(
        posed('frame', name, '', reference) for name, reference in
        [('tail', 'q'), ('p', 'q'), ('q', 'p'), ('tail2', 'tail')]).replace('<pose', '\n<pose')
    error = only_error(model_file(A + '\n' + frames))
    assert error.line == 5
    assert error.element == '/sdf/model[@name="m"]/frame[@name="p"]'


def test_every_cycle_is_reported():
    frames = ''.join(
        posed('frame', name, '', reference) for name, reference in
        [('p', 'q'), ('q', 'p'), ('r', 'r'), ('s', 't'), ('t', 'u'), ('u', 's')])
    assert codes_of(model_file(A + frames)) == ['POSE_RELATIVE_TO_CYCLE'] * 3


@pytest.mark.parametrize(('count', 'more'), [(11, ''), (12, '(2 more)'), (500, '(490 more)')])
def test_long_cycle_is_cut_in_the_message(count, more):
    frames = ''.join(posed('frame', f'f{i}', '', f'f{(i + 1) % count}') for i in range(count))
    message = only_error(model_file(A + frames)).message
    assert len(message) < 400
    assert '"m::f0" -> "m::f1" -> "m::f2" -> ' in message
    assert more in message
    assert ('more' in message) is bool(more)


@pytest.mark.parametrize(('reference', 'is_default'), [('', True), ('b', False)])
def test_message_explains_the_default_reference_of_a_joint(reference, is_default):
    error = only_error(model_file(A + posed('link', 'b', '', 'j') + fixed_joint(
        'j', 'a', 'b', f'<pose relative_to="{reference}"/>')))
    assert ('the default reference of a joint is its child' in error.message) is is_default


# Models

def test_unknown_canonical_link_of_a_static_model_is_accepted():
    scene = load_text(model_file('<static>1</static>' + A, attributes='canonical_link="zzz"'))
    assert name_at(scene, scene.canonical_links, 'm') == 'm::a'


@pytest.mark.parametrize(('content', 'canonical', 'link'), [
    (A + B, '', 'm::a'),
    (A + B, 'b', 'm::b'),
    (NESTED + A, '', 'm::a'),
    (NESTED, '', 'm::n::k'),
    ('<model name="x"><model name="y"><link name="z"/></model></model>' + NESTED, '',
     'm::x::y::z'),
    (A + NESTED, 'n::k', 'm::n::k'),
    (A + NESTED, 'n', 'm::n::k'),
    (A + B + fixed_joint('j', 'a', 'b'), 'j', 'm::b'),
    (A + B + '<frame name="f" attached_to="b"/>', 'f', 'm::b'),
    (A + B, ' b ', 'm::b'),
    ('<static>true</static>' + A + B, '', 'm::a'),
    ('<static>true</static>' + A + B, 'b', 'm::b'),
])
def test_canonical_link(content, canonical, link):
    scene = load_text(model_file(content, attributes=f'canonical_link="{canonical}"'))
    assert name_at(scene, scene.canonical_links, 'm') == link


def test_canonical_link_can_be_in_a_static_model():
    scene = load_text(model_file(
        '<model name="n"><static>1</static><link name="l"/><frame name="f"/></model>'
        '<frame name="a" attached_to="n::f"/><frame name="b"/>' + fixed_joint('j', 'a', 'b')))
    assert name_at(scene, scene.canonical_links, 'm') == 'm::n::l'
    assert name_at(scene, scene.bodies, 'm::b') == 'm::n::l'
    assert name_at(scene, scene.bodies, 'm::a') == 'm::n'


@pytest.mark.parametrize('canonical', ['', 'b', 'f'])
def test_canonical_link_moves_nothing(canonical):
    scene = load_text(model_file(
        '<pose>0 0 1 0 0 0</pose>' + A + B + '<frame name="f" attached_to="b"/>'
        + posed('frame', 'g', '0 5 0 0 0 0'), attributes=f'canonical_link="{canonical}"'))
    assert_at(scene, 'm', (0, 0, 1))
    assert_at(scene, 'm::g', (0, 5, 1))


# Default references

def test_reference_of_an_inertial_is_the_link():
    scene = load_text(model_file(
        '<link name="a"><pose>1 0 0 0 0 0</pose><inertial><pose>0 1 0 0 0 0</pose></inertial>'
        '</link>'))
    assert scene.kinds[-1] == Kind.INERTIAL
    assert scene.poses[-1, :3].tolist() == [1, 1, 0]


# Attachment

@pytest.mark.parametrize(('name', 'body'), [
    ('m::a', 'm::a'), ('m::b', 'm::b'), ('m', 'm::a'), ('m::n', 'm::n::k'), ('m::j', 'm::b'),
    ('m::f', 'm::a'), ('m::on_b', 'm::b'), ('m::on_j', 'm::b'), ('m::on_n', 'm::n::k'),
    ('m::on_s', 'm::s'), ('m::s', 'm::s'), ('on_m', 'm::a'), ('fixed', 'world'),
    ('on_fixed', 'world'),
])
def test_body_of_a_frame(name, body):
    scene = load_text(world_file(
        '<model name="m">' + A + B + NESTED + fixed_joint('j', 'a', 'b')
        + '<frame name="f"><pose relative_to="b"/></frame>'
        '<frame name="on_j" attached_to="on_b"/><frame name="on_b" attached_to="j"/>'
        '<frame name="on_n" attached_to="n"/><frame name="on_s" attached_to="s"/>'
        '<model name="s"><static>1</static></model></model>'
        '<frame name="on_m" attached_to="m"/><frame name="fixed"/>'
        '<frame name="on_fixed" attached_to="fixed"><pose relative_to="m::a"/></frame>'))
    assert name_at(scene, scene.bodies, name) == body
