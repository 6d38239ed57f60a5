# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Parents in TF: what a frame is fixed to, or what a joint connects it to."""

import numpy as np
import pytest
from sdf_texts import element, fixed_joint, model_file, posed, world_file

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import example, given
from hypothesis import strategies as st

from sdf_pose_bridge import load_text
from sdf_pose_bridge.tf.parents import tf_parents_from_scene

LINKS = '<link name="a"/><link name="b"/><link name="c"/>'


def parents_of(text):
    """Return the name of each element's parent by its own name, and the whole answer."""
    scene = load_text(text)
    answer = tf_parents_from_scene(scene)
    assert len(answer.parents) == len(scene.names)
    return {
        name: scene.names[parent]
        for name, parent in zip(scene.names, answer.parents, strict=True) if parent >= 0
    }


def model(name, children):
    return f'<model name="{name}">{children}</model>'


def joints(*pairs):
    return ''.join(
        fixed_joint(f'{parent}_{child}'.replace('::', '_'), parent, child)
        for parent, child in pairs)


# One row of the table each

@pytest.mark.parametrize('tag', [
    'visual', 'collision', 'sensor', 'light', 'particle_emitter', 'projector'])
def test_the_parent_of_a_child_of_a_link_is_the_link(tag):
    text = model_file('<link name="a"/><link name="b">' + posed(tag, 'x', '', 'a') + '</link>')
    assert parents_of(text)['m::b::x'] == 'm::b'


@pytest.mark.parametrize(('attached_to', 'parent'), [
    ('b', 'm::b'), ('g', 'm::g'), ('j', 'm::j'), ('n', 'm::n'), ('n::k', 'm::n::k'), ('', 'm'),
    ('__model__', 'm'),
])
def test_the_parent_of_a_frame_is_what_it_is_attached_to(attached_to, parent):
    text = model_file(
        LINKS + joints(('a', 'b')).replace('a_b', 'j') + '<frame name="g" attached_to="c"/>'
        + model('n', '<link name="k"/>')
        + f'<frame name="f" attached_to="{attached_to}"><pose relative_to="a"/></frame>')
    assert parents_of(text)['m::f'] == parent


@pytest.mark.parametrize(('attached_to', 'parent'), [
    ('m', 'm'), ('m::a', 'm::a'), ('', 'world'), ('world', 'world'), ('g', 'g')])
def test_a_frame_of_a_world(attached_to, parent):
    text = world_file(
        model('m', LINKS) + '<frame name="g"/>'
        f'<frame name="f" attached_to="{attached_to}"><pose relative_to="m"/></frame>')
    assert parents_of(text)['f'] == parent


@pytest.mark.parametrize(('canonical', 'link'), [('', 'm::a'), ('b', 'm::b'), ('n::k', 'm::n::k')])
def test_the_parent_of_a_model_is_its_canonical_link(canonical, link):
    text = model_file(
        LINKS + model('n', '<link name="k"/>'), attributes=f'canonical_link="{canonical}"')
    assert parents_of(text)['m'] == link
    assert parents_of(text)['m::n'] == 'm::n::k'


TWO_IN_NESTED = model('n', '<link name="k"/><link name="k2"/>')
STATIC_LINK = model('s', '<static>1</static><link name="l"/>')
PARENTS = {
    'an inertial: its link': (
        model_file('<link name="a"><inertial/></link>'), {'m::a::inertial': 'm::a'}),
    'joints and their sensors: the child link, also of a frame': (
        model_file(LINKS + '<frame name="f" attached_to="c"/>' + joints(('a', 'b'))
                   + fixed_joint('j', 'b', 'f', element('sensor', 's'))),
        {'m::a_b': 'm::b', 'm::j': 'm::c', 'm::j::s': 'm::c'}),
    'a model of models: the first link below': (
        model_file(model('n', '<link name="k"/>')),
        {'m': 'm::n::k', 'm::n::k': '__root__'}),
    'a link: on the other side of a joint': (
        model_file(LINKS + joints(('a', 'b'), ('b', 'c'))),
        {'m::c': 'm::b', 'm::b': 'm::a', 'm::a': '__root__'}),
    'a link without a joint: the canonical link': (
        model_file(LINKS, attributes='canonical_link="b"'),
        {'m::a': 'm::b', 'm::b': '__root__', 'm::c': 'm::b'}),
    'the first of joined links: the canonical link': (
        model_file(LINKS + '<link name="d"/>' + joints(('c', 'b'), ('b', 'd'))),
        {'m::c': 'm::a', 'm::b': 'm::c', 'm::d': 'm::b'}),
    'a nested model without a joint: the canonical link around it': (
        model_file(LINKS + model(
            'n', '<link name="k"/><link name="k2"/>' + model('o', '<link name="p"/>'))),
        {'m::n::k': 'm::a', 'm::n::k2': 'm::n::k', 'm::n::o::p': 'm::n::k'}),
    'a nested model: what a joint connects it to': (
        model_file(LINKS + TWO_IN_NESTED + joints(('b', 'n::k2'))),
        {'m::n::k2': 'm::b', 'm::n': 'm::n::k', 'm::n::k': 'm::a'}),
    'lights and actors of a world: the world': (
        world_file("""
            <model name="m"><link name="a"/><link name="b"/><link name="c"/></model>
            <light name="sun" type="point"><pose relative_to="m"/></light>
            <actor name="man"/>"""),
        {'sun': 'world', 'man': 'world'}),
    'a static model without links': (
        world_file(model('m', '<static>1</static><frame name="f"/>')
                   + '<frame name="g" attached_to="m"/>'),
        {'m': 'world', 'm::f': 'm', 'g': 'm'}),
    'a static model with links': (
        world_file(model('m', '<static>1</static>' + LINKS + '<frame name="f"/>')),
        {'m': 'm::a', 'm::a': 'world', 'm::b': 'm::a', 'm::f': 'm'}),
    'a joint to a static model': (
        world_file(STATIC_LINK + model('m', LINKS) + joints(('s', 'm::b'))),
        {'m::b': 's::l', 'm::a': 'world', 's::l': 'world'}),
    'a static model that is the child of a joint, also in a second world: its parent in TF': (
        world_file('</world><world name="v">' + model('m', LINKS) + STATIC_LINK
                   + joints(('m::a', 's'))),
        {'m::a': 's::l', 's::l': 'world', 'm_a_s': 's::l'}),
    'a static model in a model: what a joint connects it to': (
        model_file(LINKS + STATIC_LINK + joints(('a', 's'))),
        {'m::s::l': 'm::a', 'm::a': '__root__'}),
    'a nested model that a joint connects to another top-level one: the link of that': (
        world_file(model('a', LINKS + model('n', LINKS)) + model('b', LINKS) + joints(
            ('a::n', 'b'))), {'a::n::a': 'b::a', 'b::a': 'world'}),
    'a link that a joint connects to a nested model: its canonical link': (
        model_file(LINKS + TWO_IN_NESTED + joints(('b', 'n::k'))),
        {'m::b': 'm::n::k', 'm::n::k': 'm::a'}),
    'a link that is joined to the world: the world': (
        world_file(model('m', LINKS + joints(('a', 'b'), ('world', 'b'), ('b', 'c')))),
        {'m::b': 'world', 'm::a': 'm::b', 'm::c': 'm::b', 'm': 'm::a'}),
    'a model file joined to the world': (
        model_file(LINKS + joints(('a', 'b'), ('world', 'b'))),
        {'m::b': '__root__', 'm::a': 'm::b'}),
    'a joint to a frame of the world': (
        world_file(model('m', LINKS) + '<frame name="f"/>' + joints(('f', 'm::b'))),
        {'m::b': 'world'}),
    'a chain of models: begins at the one that is joined to the world': (
        world_file(''.join(model(name, f'<link name="{name}"/>') for name in 'pqr')
                   + joints(('p', 'q'), ('q', 'r'), ('world', 'r'))),
        {'r::r': 'world', 'q::q': 'r::r', 'p::p': 'q::q'}),
    'a loop: its last joint is left out': (
        model_file(LINKS + joints(('a', 'b'), ('b', 'c'), ('c', 'a'))),
        {'m::b': 'm::a', 'm::c': 'm::b', 'm::c_a': 'm::a'}),
    'a loop with two ways to the first link': (
        model_file(LINKS + joints(('a', 'b'), ('c', 'b'), ('a', 'c'))),
        {'m::b': 'm::a', 'm::c': 'm::b', 'm::a_c': 'm::c'}),
    'a loop through the world': (
        model_file(LINKS + joints(('world', 'a'), ('a', 'b'), ('b', 'c'), ('world', 'c'))),
        {'m::a': '__root__', 'm::b': 'm::a', 'm::c': 'm::b'}),
}
"""Files with the parents of some of their elements."""


@pytest.mark.parametrize(('text', 'expected'), PARENTS.values(), ids=PARENTS)
def test_parents(text, expected):
    parents = parents_of(text)
    assert {name: parents[name] for name in expected} == expected


# Any joints

BODIES = [f'{name}::{link}' for name in 'pqr' for link in 'abc']


@given(st.lists(st.tuples(st.sampled_from(['world', *BODIES]), st.sampled_from(BODIES))))
@example([('p::a', 'q::a'), ('q::a', 'r::a'), ('r::a', 'p::a')])
def test_a_joint_connects_a_child_to_its_parent_or_closes_a_loop(pairs):
    pairs = [(parent, child) for parent, child in pairs if parent != child]
    text = world_file(
        ''.join(model(name, LINKS) for name in 'pqr')
        + ''.join(fixed_joint(f'j{i}', *pair) for i, pair in enumerate(pairs)))
    parents = parents_of(text)
    scene = load_text(text)
    loops = [scene.names[joint.element] for joint in tf_parents_from_scene(scene).loop_joints]
    connected = {body: {body} for body in ['world', *BODIES]}
    for i, (parent, child) in enumerate(pairs):
        assert (f'j{i}' in loops) == (child in connected[parent])
        if f'j{i}' not in loops:
            assert parents[child] == parent or parents[parent] == child
            connected[parent] |= connected[child]
            for body in connected[parent]:
                connected[body] = connected[parent]


# Models that move freely

A, B = model('a', LINKS), model('b', LINKS)


@pytest.mark.parametrize(('content', 'only_model', 'expected'), [
    (A.replace('<link', '<static>true</static><link', 1) + B, '', ['b']),
    (A + B + fixed_joint('j', 'world', 'a'), '', ['b']),
    (A + B + '<joint name="j" type="fixed"><parent>a</parent><child>b</child></joint>', '', ['a']),
    (A + model('b', LINKS + model('n', LINKS)), '', ['a', 'b', 'b::n']),
    ("""
        <model name="b">
          <link name="a"/>
          <link name="b"/>
          <link name="c"/>
          <model name="n"><link name="a"/><link name="b"/><link name="c"/></model>
          <joint name="j" type="fixed"><parent>a</parent><child>n::a</child></joint>
        </model>""", '', ['b']),
    (model('b', model('n', LINKS)), '', ['b']),
    (A + model('ab', LINKS + model('n', LINKS)), 'ab::n', ['ab', 'ab::n']),
    (A + model('ab', LINKS + model('n', LINKS)), 'a', ['a']),
    (f'{A}</world><world name="v">{B}', '', ['a']),
], ids=['static', 'joined to the world', 'joined to another', 'nested', 'joined nested',
        'canonical link in a nested one', 'only a nested one', 'only one', 'in another world'])
def test_models_move_freely_unless_they_are_static_or_joined(content, only_model, expected):
    scene = load_text(world_file(content))
    found = tf_parents_from_scene(scene).with_free_models(
        scene, np.zeros(len(scene.names), np.bool_), only_model)
    assert [scene.names[each] for each in found.free_models.values()] == expected
    assert all(found.parents[link] == 0 for link in found.free_models)


def test_models_in_a_model_without_a_transform_stay_in_it():
    scene = load_text(world_file(A + model('b', LINKS + model('n', LINKS))))
    found = tf_parents_from_scene(scene).with_free_models(
        scene, np.array([name == 'b::a' for name in scene.names]), '')
    assert [scene.names[each] for each in found.free_models.values()] == ['a']
