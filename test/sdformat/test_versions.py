# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Versions: which exist, and how they are written."""

import pytest
from sdf_texts import codes_of
from sdf_texts import LINK
from sdf_texts import model_file
from sdf_texts import names_of

from sdf_pose_bridge import load_text
from sdf_pose_bridge.sdformat.versions import version_numbers


@pytest.mark.parametrize('version', [
    '', '1', '1.0', '1.1', '1.13', '2.0', '0.9', '1.6.0', ' 1.9 ', '1.9 ', '1.09', '01.9',
    'latest', 'one', '1.x', '-1.9', '1.-9', '1,9', '١.٩', '\u0661.9', '1.' + '9' * 5000,
])
def test_version_that_does_not_exist_is_refused(version):
    assert codes_of(model_file(LINK, version=version)) == ['CONVERSION_ERROR']


@pytest.mark.parametrize('minor', range(2, 13))
def test_every_version_is_read_with_the_newest_grammar(minor):
    frame = '<frame name="f"><pose degrees="1" relative_to="l"/></frame>'
    scene = load_text(model_file(LINK + frame, version=f'1.{minor}'))
    assert names_of(scene) == ['m', 'm::l', 'm::f']


@pytest.mark.parametrize(('text', 'numbers'), [
    ('1.10', (1, 10)), ('1', (1,)), ('1.9.2', (1, 9, 2)), ('', ()), ('1.', ()), ('1.x', ()),
    ('-1.9', ()), ('\u0661.9', ()), ('1.' + '9' * 5000, ()),
])
def test_numbers_of_a_version(text, numbers):
    assert version_numbers(text) == numbers
