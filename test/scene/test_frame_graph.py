# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The frame graph: unknown names, cycles, default references, and attachment."""

import pytest
from sdf_texts import (
    assert_at,
    codes_of,
    element,
    fixed_joint,
    model_file,
    only_error,
    posed,
    warning_codes,
    world_file,
)

from sdf_pose_bridge import load_text

A = '<link name="a"/>'
B = '<link name="b"><pose>1 0 0 0 0 1.5707963267948966</pose></link>'
RING = posed('frame', 'f', '', 'g') + posed('frame', 'g', '', 'f')
LOOP = '<frame name="f" attached_to="g"/><frame name="g" attached_to="f"/>'
NESTED = '<model name="n"><pose>0 0 1 0 0 0</pose><link name="k"/></model>'


def name_at(scene, indices, name):
    """Return the name of the element that an array has for another; None for -1."""
    index = int(indices[scene.index(name)])
    return None if index < 0 else scene.names[index]


def with_canonical_link(content):
    """Return a model file whose canonical link is ``f``."""
    return model_file(content, attributes='canonical_link="f"')


def with_a(content):
    """Return a model file with the link ``a`` and more."""
    return model_file(A + content)


REFUSED = {
    'POSE_RELATIVE_TO_INVALID': {
        with_a: ['<model name="n" placement_frame="a"><link name="k"/></model>'],
    },
    'FRAME_ATTACHED_TO_INVALID': {
        with_a: [
            '<frame name="f" attached_to="zzz"/>', '<frame name="f" attached_to="m"/>',
            '<frame name="f" attached_to="zzz"><pose relative_to="a"/></frame>'],
        world_file: ['<frame name="f" attached_to="zzz"/>'],
    },
    'POSE_RELATIVE_TO_CYCLE': {
        with_a: [
            '<frame name="f"><pose relative_to="f"/></frame>',
            RING,
            posed('link', 'b', '', 'j') + fixed_joint('j', 'a', 'b'),
            *(f'<model name="n"><pose relative_to="{name}"/><link name="k"/></model>'
              for name in ('n', 'n::k', 'n::__model__')),
            f'<model name="n" placement_frame="f"><link name="k"/>{RING}</model>'],
        world_file: [
            '<model name="n"><pose relative_to="f"/><link name="k"/></model>'
            + posed('frame', 'f', '', 'n::k'), '<frame name="f"><pose relative_to="f"/></frame>'],
    },
    'FRAME_ATTACHED_TO_CYCLE': {
        with_a: [
            '<frame name="f" attached_to="f"/>',
            '<frame name="f" attached_to="f"><pose relative_to="a"/></frame>',
            LOOP + fixed_joint('j', 'f', 'g'),
            LOOP.replace('"f"/>', '"f"><pose relative_to="h"/></frame>')
            + posed('frame', 'h', '', 'f'),
            '<frame name="f" attached_to="j"/>' + fixed_joint('j', 'a', 'f'),
            '<joint name="j" type="fixed"><parent>a</parent><child>j</child></joint>'],
        world_file: [LOOP],
        with_canonical_link: [A + '<frame name="f"/>'],
    },
    'MODEL_WITHOUT_LINK': {
        model_file: ['', '<frame name="f"/>', '<static>false</static>'],
        with_a: ['<model name="n"/>'],
        world_file: ['<model name="m"/>'],
        with_canonical_link: ['', '<frame name="f"/>'],
    },
}
"""Contents of files, by the code of the error."""


@pytest.mark.parametrize(('code', 'file_with', 'content'), [
    (code, file_with, content) for code, files in REFUSED.items()
    for file_with, contents in files.items() for content in contents])
def test_wrong_reference_is_refused_once(code, file_with, content):
    assert codes_of(file_with(content)) == [code]


def test_model_frame_is_not_the_canonical_link():
    assert codes_of(model_file(A, attributes='canonical_link="__model__"')) == [
        'FRAME_ATTACHED_TO_CYCLE']


# Unknown names

@pytest.mark.parametrize('text', [
    *map(with_a, (
        '<link name="b"><pose relative_to="zzz"/></link>',
        '<frame name="f"><pose relative_to="zzz"/></frame>',
        '<model name="n"><pose relative_to="zzz"/><link name="k"/></model>',
        B + fixed_joint('j', 'a', 'b', '<pose relative_to="zzz"/>'))),
    world_file('<model name="m"><pose relative_to="zzz"/><link name="k"/></model>'),
    world_file('<frame name="f"><pose relative_to="zzz"/></frame>'),
    model_file(A, attributes='placement_frame="zzz"'),
])
def test_unknown_reference_of_a_pose_is_refused(text):
    error = only_error(text)
    assert error.code == 'POSE_RELATIVE_TO_INVALID'
    assert '"zzz"' in error.message


def test_unknown_attachment_closes_no_cycle():
    assert codes_of(with_canonical_link(
        A + '<frame name="g" attached_to="zzz"/>' + fixed_joint('f', 'a', 'g'))) == [
            'FRAME_ATTACHED_TO_INVALID']


def test_unknown_name_gives_no_other_errors():
    text = model_file("""
        <link name="a"/>
        <frame name="f" attached_to="zzz"/>
        <frame name="g" attached_to="f"/>
        <link name="b"><pose relative_to="f"/></link>
        <joint name="j" type="fixed"><parent>a</parent><child>g</child></joint>""")
    assert codes_of(text)[0] == 'FRAME_ATTACHED_TO_INVALID'
    assert 'POSE_RELATIVE_TO_INVALID' not in codes_of(text)


@pytest.mark.parametrize('text', [
    *(model_file(f'<link name="a">{posed(tag, "ghost", "", "zzz")}{element(tag, "good")}</link>')
      for tag in ('visual', 'collision', 'sensor', 'light', 'particle_emitter', 'projector')),
    model_file(A + B + fixed_joint(
        'good', 'a', 'b', posed('sensor', 'ghost', '', 'zzz'))),
    world_file(posed('light', 'ghost', '', 'zzz') + element('light', 'good')),
])
def test_element_that_is_no_frame_with_an_unknown_reference_is_left_out(text):
    scene = load_text(text)
    assert (scene.own_name(-1), 'ghost' in scene.names[-2]) == ('good', False)
    assert warning_codes(scene) == ['POSE_RELATIVE_TO_INVALID']
    assert '"zzz"' in scene.warnings[0].message


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


def test_cycle_of_attachments_is_reported_at_the_element_not_its_pose():
    error = only_error(with_a(LOOP.replace('"g"/>', '"g">\n<pose/></frame>')))
    assert error.line == 1


def test_every_cycle_is_reported():
    frames = """
        <frame name="p"><pose relative_to="q"/></frame>
        <frame name="q"><pose relative_to="p"/></frame>
        <frame name="r" attached_to="r"><pose relative_to="r"/></frame>
        <frame name="s"><pose relative_to="t"/></frame>
        <frame name="t"><pose relative_to="u"/></frame>
        <frame name="u"><pose relative_to="s"/></frame>"""
    assert codes_of(model_file(A + frames)) == [
        'POSE_RELATIVE_TO_CYCLE', 'FRAME_ATTACHED_TO_CYCLE', *['POSE_RELATIVE_TO_CYCLE'] * 2]


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
    ('<static>1</static>' + A, 'zzz', 'm::a'),
    (A + '<model name="n"><static>1</static><frame name="f"/></model>', 'n::f', None),
])
def test_canonical_link(content, canonical, link):
    scene = load_text(model_file(content, attributes=f'canonical_link="{canonical}"'))
    assert name_at(scene, scene.canonical_links, 'm') == link


@pytest.mark.parametrize(('canonical', 'link'), [('', 'm::n::l'), ('g', 'm::n::k')])
def test_canonical_link_can_be_in_a_static_model(canonical, link):
    scene = load_text(model_file(
        f'<model name="n" canonical_link="{canonical}"><static>1</static><link name="l"/>'
        '<link name="k"/><frame name="f"/><frame name="g" attached_to="k"/></model>'
        '<frame name="a" attached_to="n::f"/><frame name="b"/>' + fixed_joint('j', 'a', 'b')))
    assert name_at(scene, scene.canonical_links, 'm') == link
    assert name_at(scene, scene.bodies, 'm::b') == link
    assert name_at(scene, scene.bodies, 'm::a') == 'm::n'


@pytest.mark.parametrize('canonical', ['', 'b', 'f'])
def test_canonical_link_moves_nothing(canonical):
    content = """
        <pose>0 0 1 0 0 0</pose>
        <link name="a"/>
        <link name="b"><pose>1 0 0 0 0 1.5707963267948966</pose></link>
        <frame name="f" attached_to="b"/>
        <frame name="g"><pose>0 5 0 0 0 0</pose></frame>"""
    scene = load_text(model_file(content, attributes=f'canonical_link="{canonical}"'))
    assert_at(scene, 'm', (0, 0, 1))
    assert_at(scene, 'm::g', (0, 5, 1))


# Attachment

@pytest.mark.parametrize(('name', 'body'), [
    ('m::a', 'm::a'), ('m::b', 'm::b'), ('m', 'm::a'), ('m::n', 'm::n::k'), ('m::j', 'm::b'),
    ('m::f', 'm::a'), ('m::on_b', 'm::b'), ('m::on_j', 'm::b'), ('m::on_n', 'm::n::k'),
    ('m::on_s', 'm::s'), ('m::s', 'm::s'), ('on_m', 'm::a'), ('fixed', 'world'),
    ('on_fixed', 'world'),
])
def test_body_of_a_frame(name, body):
    scene = load_text(world_file("""
        <model name="m">
          <link name="a"/>
          <link name="b"><pose>1 0 0 0 0 1.5707963267948966</pose></link>
          <model name="n"><pose>0 0 1 0 0 0</pose><link name="k"/></model>
          <joint name="j" type="fixed"><parent>a</parent><child>b</child></joint>
          <frame name="f"><pose relative_to="b"/></frame>
          <frame name="on_j" attached_to="on_b"/>
          <frame name="on_b" attached_to="j"/>
          <frame name="on_n" attached_to="n"/>
          <frame name="on_s" attached_to="s"/>
          <model name="s"><static>1</static></model>
        </model>
        <frame name="fixed"/>
        <frame name="on_fixed" attached_to="fixed"><pose relative_to="m::a"/></frame>
        <frame name="on_m" attached_to="m"/>"""))
    assert name_at(scene, scene.bodies, name) == body
    assert name_at(scene, scene.canonical_links, 'm::s') is None
