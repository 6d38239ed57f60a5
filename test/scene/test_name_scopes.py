# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Which frames references name: siblings and downwards, never upwards."""

import pytest
from sdf_texts import (
    element,
    errors_of,
    model_file,
    only_error,
    posed,
    world_file,
)

from sdf_pose_bridge import load_text

MODELS = """
    <link name="l"><pose>1 0 0 0 0 0</pose></link>
    <model name="n"><pose>0 1 0 0 0 0</pose>
      <link name="k"><pose>0 1 0 0 0 0</pose></link>
      <frame name="f"><pose>0 2 0 0 0 0</pose></frame>
      <model name="n2"><pose>0 0 1 0 0 0</pose>
        <link name="deep"><pose>0 0 1 0 0 0</pose></link>
        {inner}
      </model>
    </model>
    {outer}"""


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
        model + '</model>' + '<frame name="r"><pose>7 0 0 0 0 0</pose></frame>'
        + '<light name="sun" type="point"/><actor name="man"/>'
        + posed('frame', 'probe', '', reference))


@pytest.mark.parametrize(('reference', 'position'), [
    ('l', (1, 0, 0)), ('n', (0, 1, 0)), ('__model__', (0, 0, 0)), ('n::k', (0, 2, 0)),
    ('n::f', (0, 3, 0)), ('n::__model__', (0, 1, 0)), ('n::n2', (0, 1, 1)),
    ('n::n2::deep', (0, 1, 2)), ('n::n2::__model__', (0, 1, 1)), (' n::k ', (0, 2, 0)),
])
def test_reference_in_a_model(reference, position):
    scene = load_text(in_model(reference))
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


@pytest.mark.parametrize('text', [
    *map(in_nested, ['l', 'k', 'f', 'n', 'n2', 'n2::deep', 'n::k', 'm', 'world']),
    *map(in_world, [
        '__model__', 'w', 'w::m', 'world::m', 'world::r', 'l', 'sun', 'man', 'r::__model__']),
    *(model_file(f'<link name="l">{element(tag, "v")}</link>' + posed('frame', 'f', '', 'l::v'))
      for tag in ('visual', 'collision', 'sensor', 'light')),
    '<sdf version="1.10"><world name="a"><frame name="f"/></world><world name="b">'
    + posed('frame', 'g', '', 'f') + '</world></sdf>',
])
def test_reference_to_what_is_not_in_the_scope_is_refused(text):
    assert only_error(text).code == 'POSE_RELATIVE_TO_INVALID'


@pytest.mark.parametrize(('reference', 'position'), [
    ('world', (0, 0, 0)), ('m', (0, 0, 5)), ('m::__model__', (0, 0, 5)), ('r', (7, 0, 0)),
    ('m::l', (1, 0, 5)), ('m::n::n2::deep', (0, 1, 7)), ('m::n::__model__', (0, 1, 5)),
])
def test_reference_in_a_world(reference, position):
    assert load_text(in_world(reference)).pose('probe')[:3] == position


def test_reference_names_a_frame_of_its_own_world():
    text = """
        <sdf version="1.10">
          <world name="a"><frame name="f"><pose>1 0 0 0 0 0</pose></frame></world>
          <world name="b">
            <frame name="f"><pose>2 0 0 0 0 0</pose></frame>
            <frame name="g"><pose relative_to="f"/></frame>
          </world>
        </sdf>"""
    assert load_text(text).pose('g')[:3] == (2, 0, 0)


@pytest.mark.parametrize('content', ['{link}{model}', '{model}{link}'])
def test_a_name_with_a_separator_cannot_be_that_of_another_element(content):
    message = only_error(model_file(content.format(
        link='<link name="n::k"/>', model='<model name="n"><link name="k"/></model>'),
        version='1.6')).message
    assert message.startswith('the name "m::n::k" is in use already')


# Hints in messages

@pytest.mark.parametrize(('text', 'words'), [
    (model_file('<link name="shoulder"/><frame name="f"><pose relative_to="shoulder1"/></frame>'),
     ['did you mean "shoulder"?']),
    (in_model('n::n2::dep'), ['did you mean "n::n2::deep"?']),
    (model_file('<model name="n"><link name="l"/></model><frame name="n_l"/>'
                + posed('frame', 'f', '', 'n/l')), ['did you mean "n::l"?']),
    (in_model('m::l'), ['its own name is not visible', '"l"']),
    (in_model('m'), ['"__model__"']),
    (in_model('world'), ['in a model only joints can name the world']),
    (in_nested('l'), ['enclosing scopes']),
    (in_nested('n2/deep'), ['has a frame "n2::deep", but names of enclosing scopes']),
    (in_nested('m::l'), ['the top of the file has a frame "m::l"']),
    (in_nested('zzz'), ['model "m::n::n2"']),
    (in_nested('__modl__'), ['did you mean "__model__"?']),
    (in_model('n::__modl__'), ['did you mean "n::__model__"?']),
    (in_world('wrld'), ['did you mean "world"?']),
    (world_file(posed('frame', 'r', '') + '<model name="m"><link name="l"/>'
                + posed('frame', 'f', '', 'r') + '</model>'), ['world "w" has a frame "r"']),
    (in_world('zzz'), ['world "w"']),
])
def test_message_helps_to_find_the_name(text, words):
    message = only_error(text).message
    assert [word for word in words if word not in message] == []


@pytest.mark.parametrize('text', [in_model('zzzzzz'), in_world('w::m')])
def test_message_has_no_hint_if_no_name_is_similar(text):
    assert ';' not in only_error(text).message


def test_many_unknown_references_among_many_names_are_reported_fast():
    links = ''.join(f'<link name="l{i}"/>' for i in range(3000))
    wrong = ''.join(posed('frame', f'f{i}', '', f'wrong{i}') for i in range(30))
    assert len(errors_of(model_file(links + wrong))) == 30
