# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Formats and units that a command line names; test_convert.py and test_set.py have the poses."""

import pytest

from sdf_pose_bridge.geometry.formats import POSE_FORMATS, ROTATION_FORMATS


@pytest.mark.parametrize('option', ['--from', '--to'])
@pytest.mark.parametrize(('name', 'names'), [
    ('euler', 'some: rpy, rpy_degrees, ypr'), ('RPY', 'near: rpy, rpy_degrees, sdf_rpy'),
    ('ur', 'near: ur_pose, ur_pendant'), ('quat_xyz', 'near: quat_xyzw, sdf_quat_xyzw')])
def test_an_unknown_format_is_an_error_of_one_short_line(convert, option, name, names):
    given = {'--from': 'rpy', '--to': 'rpy', option: name}
    assert convert(*[word for pair in given.items() for word in pair], '0', '0', '0') == (
        2, '', f'sdf_pose convert: no format {name!r}; {names}; all: --help\n')


@pytest.mark.parametrize(('source', 'option', 'count'), [
    ('quaternion', '--degrees', 4), ('matrix', '--radians', 9), ('rpy', '--mm', 3)])
def test_a_unit_of_numbers_that_the_format_does_not_have_is_an_error(
        convert, source, option, count):
    code, out, err = convert('--from', source, option, *['1'] * count)
    assert (code, out) == (1, '')
    assert f'leave out {option}' in err


def test_two_units_of_angles_are_an_error(convert):
    code, out, err = convert('--degrees', '--radians', '--from', 'rpy', *'123')
    assert (code, out) == (2, '')
    assert 'not allowed with argument --degrees' in err


def test_the_help_lists_the_formats_with_their_units(convert):
    code, out, _ = convert('--help')
    assert code == 0
    out = ' '.join(out.split())
    for entry in (*ROTATION_FORMATS.values(), *POSE_FORMATS.values()):
        assert entry.name in out
        assert ' '.join(entry.meaning.split()) in out
