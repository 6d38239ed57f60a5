# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Which frames references name: siblings and downwards, never upwards."""

import pytest
from sdf_texts import (
    element,
    errors_of,
    fixed_joint,
    model_file,
    only_error,
    posed,
    world_file,
)

import sdf_pose_bridge

MODELS = (
    posed('link', 'l', '1 0 0 0 0 0')
    + '<model name="n"><pose>0 1 0 0 0 0</pose>'
    + posed('link', 'k', '0 1 0 0 0 0') + posed('frame', 'f', '0 2 0 0 0 0')
    + '<model name="n2"><pose>0 0 1 0 0 0</pose>' + posed('link', 'deep', '0 0 1 0 0 0')
    + '{inner}</model></model>{outer}')


def in_model(reference):
    """Return a file with a reference in the outer model."""
    probe = posed('frame', 'probe', '', reference)
    return model_file(MODELS.format(inner='', outer=probe))


def in_nested(reference):
    """Return a file with a reference in the innermost model."""
    return model_file(MODELS.format(inner=posed('frame', 'probe', '', reference), outer=''))


def in_world(reference):
    """Return a file with a reference in the world around the models."""
    model = '<model name="m"><pose>0 0 5 0 0 0</pose>' + MODELS.format(inner='', outer='')
    return world_file(
        model + '</model>' + posed('frame', 'r', '7 0 0 0 0 0')
        + '<light name="sun" type="point"/><actor name="man"/>'
        + posed('frame', 'probe', '', reference))


@pytest.mark.parametrize(('reference', 'position'), [
    ('l', (1, 0, 0)), ('n', (0, 1, 0)), ('__model__', (0, 0, 0)), ('n::k', (0, 2, 0)),
    ('n::f', (0, 3, 0)), ('n::__model__', (0, 1, 0)), ('n::n2', (0, 1, 1)),
    ('n::n2::deep', (0, 1, 2)), ('n::n2::__model__', (0, 1, 1)), (' n::k ', (0, 2, 0)),
])
def test_reference_in_a_model(reference, position):
    scene = sdf_pose_bridge.load_text(in_model(reference))
    assert scene.pose('m::probe')[:3] == position


@pytest.mark.parametrize('reference', [
    'm', 'm::l', 'm::__model__', 'k', 'deep', 'n2', 'world', 'L', 'l::', '::l', 'n:k', 'n::',
    'n::k::__model__', 'l::__model__', '__model__::l', 'n::__model__::k', 'n::world', 'n::n', 'w',
    '__model__::__model__', 'n::n2::deep::', 'n ::k',
])
def test_unknown_reference_in_a_model_is_refused(reference):
    error = only_error(in_model(reference))
    assert error.code == 'POSE_RELATIVE_TO_INVALID'
    assert f'relative_to="{reference}"' in error.message


@pytest.mark.parametrize('reference', ['l', 'k', 'f', 'n', 'n2', 'n2::deep', 'n::k', 'm', 'world'])
def test_reference_to_an_enclosing_scope_is_refused(reference):
    assert only_error(in_nested(reference)).code == 'POSE_RELATIVE_TO_INVALID'


@pytest.mark.parametrize(('reference', 'position'), [
    ('world', (0, 0, 0)), ('m', (0, 0, 5)), ('m::__model__', (0, 0, 5)), ('r', (7, 0, 0)),
    ('m::l', (1, 0, 5)), ('m::n::n2::deep', (0, 1, 7)), ('m::n::__model__', (0, 1, 5)),
])
def test_reference_in_a_world(reference, position):
    assert sdf_pose_bridge.load_text(in_world(reference)).pose('probe')[:3] == position


@pytest.mark.parametrize('reference', [
    '__model__', 'w', 'w::m', 'world::m', 'world::r', 'l', 'sun', 'man', 'r::__model__',
])
def test_unknown_reference_in_a_world_is_refused(reference):
    assert only_error(in_world(reference)).code == 'POSE_RELATIVE_TO_INVALID'


@pytest.mark.parametrize('tag', ['visual', 'collision', 'sensor', 'light'])
def test_reference_to_a_child_of_a_link_is_refused(tag):
    link = f'<link name="l">{element(tag, "v")}</link>'
    text = model_file(link + posed('frame', 'f', '', 'l::v'))
    assert only_error(text).code == 'POSE_RELATIVE_TO_INVALID'


def test_reference_to_a_joint():
    scene = sdf_pose_bridge.load_text(model_file(
        '<link name="a"/>' + posed('link', 'b', '1 0 0 0 0 0') + fixed_joint('j', 'a', 'b')
        + posed('frame', 'f', '1 0 0 0 0 0', 'j')))
    assert scene.pose('m::f')[:3] == (2, 0, 0)


def test_reference_to_another_world_is_refused():
    text = ('<sdf version="1.10"><world name="a"><frame name="f"/></world>'
            '<world name="b">' + posed('frame', 'g', '', 'f') + '</world></sdf>')
    assert only_error(text).code == 'POSE_RELATIVE_TO_INVALID'


def test_reference_names_a_frame_of_its_own_world():
    text = ('<sdf version="1.10"><world name="a">' + posed('frame', 'f', '1 0 0 0 0 0')
            + '</world><world name="b">' + posed('frame', 'f', '2 0 0 0 0 0')
            + posed('frame', 'g', '', 'f') + '</world></sdf>')
    assert sdf_pose_bridge.load_text(text).pose('g')[:3] == (2, 0, 0)


# Hints in messages

def test_message_has_the_nearest_name():
    text = model_file('<link name="shoulder"/>' + posed('frame', 'f', '', 'sholder'))
    assert 'did you mean "shoulder"?' in only_error(text).message


def test_message_has_the_nearest_name_of_a_nested_model():
    assert 'did you mean "n::n2::deep"?' in only_error(in_model('n::n2::dep')).message


def test_message_has_the_name_with_the_separator_of_sdformat():
    text = model_file(
        '<model name="n"><link name="l"/></model><frame name="n_l"/>'
        + posed('frame', 'f', '', 'n/l'))
    assert 'did you mean "n::l"?' in only_error(text).message


def test_message_has_no_name_if_none_is_similar():
    assert 'did you mean' not in only_error(in_model('zzzzzz')).message


def test_message_explains_that_the_own_name_is_not_visible():
    message = only_error(in_model('m::l')).message
    assert 'its own name is not visible' in message
    assert '"l"' in message


def test_message_has_the_name_of_the_model_frame():
    assert '"__model__"' in only_error(in_model('m')).message


def test_message_explains_that_enclosing_scopes_are_not_visible():
    assert 'enclosing scopes' in only_error(in_nested('l')).message


def test_name_with_slashes_is_searched_in_enclosing_scopes_too():
    assert 'has a frame "n2::deep", but names of enclosing scopes' in (
        only_error(in_nested('n2/deep')).message)


def test_message_has_the_scope():
    assert 'model "m::n::n2"' in only_error(in_nested('zzz')).message
    assert 'world "w"' in only_error(in_world('zzz')).message


def test_many_unknown_references_among_many_names_are_reported_fast():
    links = ''.join(f'<link name="l{i}"/>' for i in range(3000))
    wrong = ''.join(posed('frame', f'f{i}', '', f'wrong{i}') for i in range(30))
    assert len(errors_of(model_file(links + wrong))) == 30
