# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Names as SDFormat spells them."""

import pytest

from sdf_pose_bridge.names import is_reserved
from sdf_pose_bridge.names import scoped_name
from sdf_pose_bridge.sdformat.grammar import FRAME_KINDS
from sdf_pose_bridge.sdformat.grammar import Kind


@pytest.mark.parametrize('name', ['world', '__model__', '__root__', '____', '__a__', '_____'])
def test_reserved(name):
    assert is_reserved(name)


@pytest.mark.parametrize('name', [
    '', '_', '__', '___', '__x_', '_x__', '__x', 'x__', 'World', 'worlds', 'a__b',
])
def test_not_reserved(name):
    assert not is_reserved(name)


def test_a_name_in_a_scope():
    assert scoped_name('robot::arm', 'hand') == 'robot::arm::hand'


def test_a_name_in_a_world():
    assert scoped_name('', 'robot') == 'robot'


def test_labels_are_tags():
    assert Kind.PARTICLE_EMITTER.label == 'particle_emitter'
    assert Kind.LINK.label == 'link'


def test_only_four_kinds_can_be_referred_to():
    assert {kind.label for kind in FRAME_KINDS} == {'model', 'link', 'joint', 'frame'}
