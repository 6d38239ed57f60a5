# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The family of errors."""

import pickle

import pytest

from sdf_pose_bridge import errors
from sdf_pose_bridge.errors import LoadError
from sdf_pose_bridge.errors import ParsingError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.names import hint_from_names

PLACE = Place('a.sdf', 7, '/sdf')
CLASSES = [
    value for value in vars(errors).values()
    if isinstance(value, type) and issubclass(value, SdfError)
    and value not in (SdfError, LoadError)]


@pytest.mark.parametrize(('place', 'text'), [
    (Place('a.sdf'), 'a.sdf'), (Place('a.sdf', 7), 'a.sdf:7'), (PLACE, 'a.sdf:7'),
])
def test_a_place_as_text(place, text):
    assert str(place) == text


def test_an_error_as_text():
    assert str(ParsingError('this is wrong', PLACE)) == 'a.sdf:7: PARSING_ERROR: this is wrong'


def test_a_warning_as_text():
    assert str(SdfWarning('WARNING', 'take care', PLACE)) == 'a.sdf:7: WARNING: take care'


@pytest.mark.parametrize('error_class', CLASSES)
def test_every_error_has_a_code_and_a_reason(error_class):
    assert error_class.code not in ('', 'ERROR')
    assert error_class.__doc__


def test_an_error_stands_for_itself():
    error = ParsingError('x', PLACE)
    assert error.errors == (error,)
    assert error.warnings == ()
    assert (error.file, error.line, error.element) == PLACE


def test_several_errors():
    first, second = ParsingError('x', PLACE), errors.FileReadError('y', Place('b.sdf'))
    error = LoadError([first, second], [SdfWarning('WARNING', 'z', PLACE)])
    assert error.errors == (first, second)
    assert (error.code, error.message, error.place) == ('PARSING_ERROR', 'x', PLACE)
    assert str(error) == 'a.sdf:7: PARSING_ERROR: x\nb.sdf: FILE_READ: y'
    assert len(error.warnings) == 1


@pytest.mark.parametrize('error', [
    ParsingError('x', PLACE), LoadError([ParsingError('x', PLACE)], [])])
def test_errors_pass_between_processes(error):
    copy = pickle.loads(pickle.dumps(error))
    assert (str(copy), copy.code, copy.place) == (str(error), error.code, error.place)


@pytest.mark.parametrize(('wanted', 'names', 'hint'), [
    ('tabel', ['chair', 'table'], '; did you mean "table"?'),
    ('table', [], ''),
    ('table', ['x'], ''),
    ('', ['x'], ''),
])
def test_hints(wanted, names, hint):
    assert hint_from_names(wanted, names) == hint


@pytest.mark.parametrize(('wanted', 'hint'), [
    ('robot_17/link_44', 'robot_17/link_4'), ('rbot_30/link_7', 'robot_30/link_7'),
    ('robot_5_link_6', 'robot_5/link_6'), ('nothing', ''), ('', ''), ('x' * 100_000, ''),
])
def test_hints_among_many_names_that_are_alike(wanted, hint):
    names = [f'robot_{robot}/link_{link}' for robot in range(1000) for link in range(10)]
    assert hint_from_names(wanted, names) == (hint and f'; did you mean "{hint}"?')
