# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The problems of a load: their order, and how many of them are kept."""

import pytest

from sdf_pose_bridge.errors import LoadError, ParsingError, Place
from sdf_pose_bridge.problems import (
    by_message,
    MOST_HINTS,
    MOST_PROBLEMS,
    Problems,
)

PLACE = Place('a.sdf', 7, '/sdf')


@pytest.fixture
def problems():
    return Problems(['a.sdf'])


def test_load_without_errors_raises_nothing(problems):
    problems.warning('z', PLACE)
    problems.raise_errors()
    assert [warning.message for warning in problems.warnings] == ['z']


def test_load_with_errors_raises_them_with_the_warnings(problems):
    problems.warning('z', PLACE, 'CODE')
    problems.error(ParsingError('x', PLACE))
    with pytest.raises(LoadError) as caught:
        problems.raise_errors()
    assert [error.message for error in caught.value.errors] == ['x']
    assert [warning.code for warning in caught.value.warnings] == ['CODE']


def test_problems_are_ordered_by_file_and_line():
    problems = Problems(['b.sdf', 'a.sdf'])
    for place in [
            Place('other'), Place('a.sdf', 2), Place('b.sdf', 9), Place('a.sdf', 1),
            Place('b.sdf')]:
        problems.error(ParsingError('x', place))
    assert [str(error.place) for error in problems.errors] == [
        'b.sdf', 'b.sdf:9', 'a.sdf:1', 'a.sdf:2', 'other']


def test_problems_of_one_line_keep_their_order(problems):
    problems.extend([ParsingError(message, PLACE) for message in 'zyx'])
    assert [error.message for error in problems.errors] == ['z', 'y', 'x']


def test_problem_of_an_included_file_is_listed_once():
    problems = Problems(['main.sdf', 'a.sdf'])
    for element in ('/sdf/model[@name="x"]', '/sdf/model[@name="y"]'):
        problems.error(ParsingError('x', Place('a.sdf', 7, element)))
        problems.warning('z', Place('a.sdf', 7, element))
    assert (len(problems.errors), len(problems.warnings)) == (1, 1)


def test_problems_of_different_elements_of_the_first_file_are_all_listed():
    problems = Problems(['a.sdf', 'b.sdf'])
    for element in ('/sdf/model[@name="x"]', '/sdf/model[@name="y"]'):
        problems.error(ParsingError('x', Place('a.sdf', 7, element)))
    assert len(problems.errors) == 2


def test_many_errors_end_with_the_number_of_those_not_kept(problems):
    for line in range(MOST_PROBLEMS + 7):
        problems.error(ParsingError('x', Place('a.sdf', line)))
        problems.warning('z', Place('a.sdf', line))
    assert len(problems.errors) == len(problems.warnings) == MOST_PROBLEMS + 1
    assert problems.errors[-1].message == 'and 7 more errors'
    assert problems.warnings[-1].message == 'and 7 more warnings'


def test_problems_of_a_part_are_counted_in_the_whole(problems):
    problems.error(ParsingError('first', PLACE))
    part = Problems(['a.sdf'])
    for line in range(MOST_PROBLEMS + 7):
        part.error(ParsingError('x', Place('a.sdf', line)))
    problems.add_part(part)
    assert len(problems.errors) == MOST_PROBLEMS + 1
    assert problems.errors[-1].message == 'and 8 more errors'


def test_number_of_hints_is_limited(problems):
    part = Problems(['a.sdf'], hints=problems.hints)
    assert sum(part.allows_hint() for _ in range(MOST_HINTS + 5)) == MOST_HINTS
    assert not problems.allows_hint()


def test_first_error_of_an_included_file_names_the_includes_that_led_there():
    includes = {'b.sdf': Place('a.sdf', 3), 'c.sdf': Place('b.sdf', 7)}
    problems = Problems(['a.sdf', 'b.sdf', 'c.sdf'], includes)
    for line in (1, 2):
        problems.error(ParsingError('x', Place('c.sdf', line)))
        problems.error(ParsingError('x', Place('a.sdf', line)))
    assert [error.message for error in problems.errors] == [
        'x', 'x', 'x (included from b.sdf:7, included from a.sdf:3)', 'x']


def test_error_and_warning_shorten_what_they_quote(problems):
    message = f'relative_to="{"x" * 10**6}" names no frame in model "m"'
    problems.error(ParsingError(message, PLACE))
    problems.warning(message, PLACE)
    for problem in (*problems.errors, *problems.warnings):
        assert len(problem.message) < 130
        assert problem.message.endswith('x" names no frame in model "m"')


@pytest.mark.parametrize(('places', 'other_lines'), [
    (['a.sdf:1'], ['']),
    (['a.sdf:1', 'a.sdf:3'], [' (also line 3)']),
    (['a.sdf:1', 'b.sdf:3'], ['', '']),
    ([f'a.sdf:{line}' for line in range(1, 9)], [' (also lines 2, 3, 4, 5, 6 and 2 more)']),
])
def test_problems_of_a_file_with_one_message_are_joined(places, other_lines):
    parts = [place.split(':') for place in places]
    errors = [ParsingError('x', Place(path, int(line))) for path, line in parts]
    assert [text for _, text in by_message(errors)] == other_lines


def test_problems_with_other_messages_are_not_joined():
    errors = [ParsingError(message, PLACE) for message in 'xyx']
    assert [error.message for error, _ in by_message(errors)] == ['x', 'y']
