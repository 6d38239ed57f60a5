# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Errors and warnings: their texts and their codes."""

import pickle

import pytest

from sdf_pose_bridge import errors
from sdf_pose_bridge.errors import (
    FileReadError,
    LoadError,
    ParsingError,
    Place,
    SdfError,
    SdfWarning,
    UnknownFrameError,
)

PLACE = Place('a.sdf', 7, '/sdf')


def family(error):
    yield error
    for child in error.__subclasses__():
        if child.__module__ == errors.__name__:
            yield from family(child)


CLASSES = [error for error in family(SdfError) if error not in (SdfError, LoadError)]


# One error

@pytest.mark.parametrize(('place', 'text'), [
    (Place('a.sdf'), 'a.sdf'), (Place('a.sdf', 7), 'a.sdf:7'), (PLACE, 'a.sdf:7'),
])
def test_text_of_a_place(place, text):
    assert str(place) == text


@pytest.mark.parametrize('error_class', CLASSES)
def test_every_class_of_errors_has_a_code_and_a_docstring(error_class):
    assert error_class.code not in ('', 'ERROR')
    assert error_class.__doc__


def test_codes_are_different_for_errors_of_files():
    codes = [
        error_class.code for error_class in CLASSES
        if 'code' in vars(error_class) and error_class is not UnknownFrameError]
    assert len(set(codes)) == len(codes)


def test_single_error_has_a_place_and_is_the_only_one_of_its_errors():
    error = ParsingError('x', PLACE)
    assert (error.file, error.line, error.element) == PLACE
    assert (error.errors, error.warnings) == ((error,), ())


# Several errors

def test_error_of_a_load_has_all_errors_with_code_and_place_of_the_first():
    first, second = ParsingError('x', PLACE), FileReadError('y', Place('b.sdf'))
    warning = SdfWarning('WARNING', 'z', PLACE)
    error = LoadError([first, second], [warning])
    assert (error.errors, error.warnings) == ((first, second), (warning,))
    assert (error.code, error.message, error.place) == ('PARSING_ERROR', 'x', PLACE)
    assert str(error) == 'a.sdf:7: PARSING_ERROR: x\nb.sdf: FILE_READ: y'
    assert str(warning) == 'a.sdf:7: WARNING: z'


@pytest.mark.parametrize('error', [
    ParsingError('x', PLACE), LoadError([ParsingError('x', PLACE)], [])])
def test_errors_can_be_pickled(error):
    copy = pickle.loads(pickle.dumps(error))
    assert (str(copy), copy.code, copy.place) == (str(error), error.code, error.place)


@pytest.mark.parametrize('text', ['"' * 10**6, 'x' * 10**6, '"x' * 10**6])
def test_no_message_is_long(text):
    assert len(ParsingError(text, PLACE).message) <= 2000
