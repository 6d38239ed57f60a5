# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Texts that share one piece of memory are those that strings would be."""

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

from sdf_pose_bridge.tf import texts as tf_texts
from sdf_pose_bridge.tf.texts import Texts

SHORT = (
    st.text(st.characters(codec='utf-8', exclude_characters='\0'), max_size=13)
    | st.integers(0, 55).map('n'.__mul__))
STRINGS = st.lists(SHORT | st.integers(56, 130).map('n'.__mul__), max_size=6)
MANY = [f'robot_{number}/link' for number in range(2000)]


def joined(strings):
    return Texts(''.join(f'{string}\0' for string in strings).encode())


def spelled(texts):
    """Return the bytes of each."""
    return [
        texts.data[start:start + length] for start, length in zip(
            texts.starts.tolist(), texts.lengths.tolist(), strict=True)]


def test_a_zero_character_is_refused():
    with pytest.raises(ValueError, match='zero character'):
        Texts.from_strings(['a', 'b\0c'])


def test_a_zero_character_in_one_more_is_refused():
    with pytest.raises(ValueError, match='zero character'):
        joined(['a']).with_one_more('b\0c')


@pytest.mark.parametrize('make', [joined, Texts.from_strings])
@given(strings=STRINGS)
def test_texts_are_the_strings_that_they_are_made_of(make, strings):
    texts = make(strings)
    assert (len(texts), list(texts), texts.strings) == (len(strings), strings, tuple(strings))


@given(strings=STRINGS)
def test_each_has_its_bytes_and_a_zero(strings):
    assert spelled(joined(strings)) == [f'{string}\0'.encode() for string in strings]


@given(strings=STRINGS)
def test_a_chunk_begins_with_what_is_left_of_a_text_and_zeros(strings):
    texts = joined(strings)
    for start, length in zip(texts.starts.tolist(), texts.lengths.tolist(), strict=True):
        for step in range(0, length, tf_texts.CHUNK):
            chunk = texts.data[start + step:start + step + tf_texts.CHUNK]
            assert len(chunk) == tf_texts.CHUNK
            behind = chunk[length - step - 1:]
            assert behind[:tf_texts.ZEROS] == bytes(min(len(behind), tf_texts.ZEROS))


@given(strings=STRINGS, string=st.sampled_from(['', 'map', 'größe']))
def test_one_more_is_the_last(strings, string):
    assert list(joined(strings).with_one_more(string)) == [*strings, string]


@pytest.mark.parametrize('rows', [np.array([2, 0, -1, 2]), np.array([], np.int32), slice(-1)])
def test_texts_are_taken_like_rows(rows):
    strings = np.array(['a', 'größe', '', 'd'])
    taken = joined(strings.tolist()).taken(rows)
    assert list(taken) == strings[rows].tolist()
    assert spelled(taken) == [f'{string}\0'.encode() for string in strings[rows].tolist()]


@given(strings=STRINGS)
def test_repeats_are_found(strings):
    assert joined(strings).has_repeats() == (len(set(strings)) < len(strings))


@given(strings=st.lists(SHORT, max_size=6))
def test_a_text_has_one_sum_wherever_it_stands(strings):
    sums = joined([*strings, *reversed(strings)])._sums().tolist()
    assert sums == sums[::-1]


def test_hardly_any_two_texts_have_the_same_sum():
    strings = [
        f'{first}{"-" * gap}{second}' for first in range(100) for second in range(100)
        for gap in (1, 6, 14)]
    assert len(set(joined(strings)._sums().tolist())) == len(strings)


@pytest.mark.parametrize(('more', 'has_repeats'), [
    ([], False), (['robot_7/link'], True), (['robot_7/link '], False), (['', ''], True),
    (['n' * 200], False), (['n' * 200] * 2, True)])
def test_repeats_are_found_among_many(more, has_repeats):
    assert joined([*MANY, *more]).has_repeats() is has_repeats


@pytest.mark.parametrize(('more', 'has_repeats'), [([], False), (['robot_7/link'], True)])
def test_sums_that_are_the_same_do_not_make_a_repeat(monkeypatch, more, has_repeats):
    monkeypatch.setattr(tf_texts, '_FACTOR', 0)
    assert joined([*MANY, *more]).has_repeats() is has_repeats


@pytest.mark.parametrize('string', [
    ' ', 'a b', 'a\t', '\na', 'größe b', 'a\u3000b', '\u00a0', '\x1f'])
def test_white_space_is_found(string):
    assert joined(['a', string, 'b']).has_white_space()


@pytest.mark.parametrize('strings', [
    ['a'], ['a', '', 'b'], ['größe', '', 'b'], ['!', '~'], ['a\u200bb'], ['\x7f']])
def test_no_white_space(strings):
    assert not joined(strings).has_white_space()
