# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What only models and frames have."""


import pytest
from sdf_texts import errors_of
from sdf_texts import fixed_joint
from sdf_texts import LINK
from sdf_texts import model_file
from sdf_texts import only_error
from sdf_texts import posed

from sdf_pose_bridge import load_text

# The implicit root cannot be named

@pytest.mark.parametrize(('text', 'code'), [
    (model_file(posed('link', 'l', '', '__root__')), 'ATTRIBUTE_INVALID'),
    (model_file(LINK + '<frame name="f" attached_to="__root__"/>'), 'ATTRIBUTE_INVALID'),
    (model_file(LINK, attributes='canonical_link="__root__"'), 'ATTRIBUTE_INVALID'),
    (model_file(LINK, attributes='placement_frame="__root__"'), 'ATTRIBUTE_INVALID'),
    (model_file(LINK + fixed_joint('j', '__root__', 'l')), 'RESERVED_NAME'),
    (model_file(LINK + fixed_joint('j', 'l', '__root__')), 'RESERVED_NAME'),
])
def test_reference_to_the_implicit_root_is_refused(text, code):
    error = errors_of(text)[0]
    assert error.code == code
    assert '"__root__"' in error.message


# Models

@pytest.mark.parametrize('value', ['maybe', '2', 'yes', '-1'])
def test_wrong_static_is_refused(value):
    error = only_error(model_file(f'<static>{value}</static>' + LINK))
    assert error.code == 'ELEMENT_INVALID'
    assert f'"{value}"' in error.message


@pytest.mark.parametrize(('value', 'is_static'), [
    ('true', True), (' 1 ', True), ('TRUE', True), ('false', False), ('0', False), ('', False),
])
def test_model_is_static(value, is_static):
    scene = load_text(model_file(f'<static>{value}</static>' + LINK))
    assert (scene.index('m') in scene.static_models) == is_static


def test_model_is_not_static_by_default():
    assert not load_text(model_file(LINK)).static_models


def test_nested_model_of_a_static_model_is_not_static():
    scene = load_text(model_file('<static>true</static><model name="n"><link name="l"/></model>'))
    assert scene.static_models == {scene.index('m')}
