# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Names in SDFormat: reserved ones, names in scopes."""

from itertools import product

import pytest

from sdf_pose_bridge.names import is_reserved, scoped_name, unused_name


@pytest.mark.parametrize(('names', 'reserved'), [
    (['world', '__model__', '__root__', '____', '__a__', '_____'], True),
    (['', '_', '__', '___', '__x_', '_x__', '__x', 'x__', 'World', 'worlds', 'a__b'], False)])
def test_reserved_names(names, reserved):
    assert [name for name in names if is_reserved(name) is not reserved] == []


@pytest.mark.parametrize(('scope', 'name', 'scoped'), [
    ('robot::arm', 'hand', 'robot::arm::hand'), ('', 'robot', 'robot')])
def test_name_in_a_scope_or_in_a_world(scope, name, scoped):
    assert scoped_name(scope, name) == scoped


@pytest.mark.parametrize('taken', [[], ['a_1']])
def test_a_used_name_gets_the_first_number_that_is_free(taken):
    for names in product(['a', 'a_1', 'a_2', 'a_1_1'], repeat=5):
        used, all_names = dict.fromkeys(taken, 0), [*taken]
        for name in names:
            candidates = [name, *(f'{name}_{number}' for number in range(1, 9))]
            all_names.append(next(each for each in candidates if each not in all_names))
            assert unused_name(name, used) == all_names[-1]
