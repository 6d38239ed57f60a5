# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What is copied, followed and listed is right, and counted."""

import os

from lxml import etree
import pytest

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given, settings
from hypothesis import strategies as st

from sdf_pose_bridge.errors import LimitError, Place
from sdf_pose_bridge.sdformat import counted
from sdf_pose_bridge.sdformat.counted import copy_of, file_lookups, steps_of_copy
from sdf_pose_bridge.sdformat.limits import Limits, Usage

PLACE = Place('cell.sdf')


def used(usage):
    return usage.limits.work - usage.left('work')


# Copies

MANY_ATTRIBUTES = ' '.join(f'b{number}=""' for number in range(100))


def test_a_copy_has_all_but_the_text_behind_it():
    root = etree.XML('<a>1<b c="d">2<!-- 3 --><e/>4</b>5<![CDATA[6]]></a>')
    assert etree.tostring(copy_of(root[0], Usage(), PLACE)) == b'<b c="d">2<!-- 3 --><e/>4</b>'


@pytest.mark.parametrize(('small', 'large'), [
    ('<a><b/></a>', f'<a>{"<b/>" * 100}</a>'),
    ('<a><b/></a>', f'<a><b/>{"<!-- -->" * 100}</a>'),
    ('<a><b/>t</a>', f'<a><b/>{"t" * 10_000}</a>'),
    ('<a>t</a>', f'<a>{"t" * 10_000}</a>'),
    ('<a b="c"/>', f'<a b="{"c" * 10_000}"/>'),
    ('<a b="c"/>', f'<a {MANY_ATTRIBUTES}/>'),
    ('<a><b c="c"/></a>', f'<a><b c="{"c" * 10_000}"/></a>'),
])
def test_more_of_anything_counts_for_more(small, large):
    assert steps_of_copy(etree.XML(large)) >= 50 * steps_of_copy(etree.XML(small)) // 2


def test_a_copy_that_is_too_much_is_not_made():
    usage = Usage(Limits(work=100))
    with pytest.raises(LimitError, match='the limit work is 100'):
        copy_of(etree.XML(f'<a>{"<b/>" * 100}</a>'), usage, PLACE)


# Paths

@pytest.fixture(name='folder', scope='module')
def make_folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp('paths')
    (folder / 'a/b').mkdir(parents=True)
    (folder / 'a/b/file').touch()
    for name, target in {
            'link': 'a/b', 'a/up': '..', 'to_file': 'link/file', 'full': str(folder / 'a'),
            'loop': 'loop', 'one': 'two', 'two': 'one', 'nowhere': 'none/file',
            'a/b/far': '../up/./link//../b/file', 'slash': 'a/'}.items():
        (folder / name).symlink_to(target)
    return folder


NAMES = st.sampled_from([
    'a', 'b', 'file', 'link', 'up', 'to_file', 'full', 'loop', 'one', 'nowhere', 'far', 'none',
    'slash', '..', '.', '', 'x' * 300, '\0', '\ud800', '\udcff'])


@settings(max_examples=500)
@given(parts=st.lists(NAMES, max_size=7))
def test_paths_are_those_of_the_system(parts, folder):
    path = '/'.join([str(folder), *parts])
    exists, is_directory = os.path.exists(path), os.path.isdir(path)  # noqa: PTH110, PTH112
    lookups = file_lookups()
    for _ in range(2):
        assert lookups.real_path(path) == (os.path.realpath(path) if exists else None)
        assert lookups.is_directory(path) == is_directory


def test_a_relative_path_begins_in_the_working_directory(folder, monkeypatch):
    monkeypatch.chdir(folder)
    assert file_lookups().real_path('link/file') == str(folder / 'a/b/file')


def test_nothing_is_found_from_a_directory_that_is_gone(tmp_path, monkeypatch):
    (tmp_path / 'gone').mkdir()
    monkeypatch.chdir(tmp_path / 'gone')
    (tmp_path / 'gone').rmdir()
    assert file_lookups().real_path('link/file') is None


def test_a_long_way_over_links_is_followed_once(tmp_path):
    (tmp_path / 'd').mkdir()
    (tmp_path / 'file').touch()
    for number in range(20):
        target = f'l{number + 1}' if number < 19 else 'file'
        (tmp_path / f'l{number}').symlink_to(f'{"d/../" * 700}{target}')
    usage = Usage()
    lookups = file_lookups(usage, PLACE)
    assert lookups.real_path(str(tmp_path / 'l0')) == str(tmp_path / 'file')
    first = used(usage)
    assert first > 20 * 3500 // 16
    for number in range(10):
        assert lookups.real_path(f'{tmp_path}/d/{"./" * number}../l0') is not None
    assert used(usage) - first < first // 10


@pytest.mark.parametrize('count', [400, 1000])
def test_a_path_is_as_long_as_the_system_allows(folder, count):
    path = f'{folder}/{"a/b/../../" * count}a'
    exists = os.path.exists(path)  # noqa: PTH110
    assert (file_lookups().real_path(path) is not None) == exists == (count == 400)


def test_too_many_links_lead_nowhere(tmp_path):
    (tmp_path / 'file').touch()
    for number in range(60):
        (tmp_path / f'l{number}').symlink_to(f'l{number + 1}' if number < 59 else 'file')
    lookups = file_lookups()
    assert lookups.real_path(str(tmp_path / 'l0')) is None
    assert lookups.real_path(str(tmp_path / 'l30')) == str(tmp_path / 'file')


def test_a_directory_is_listed_once(tmp_path, monkeypatch):
    for number in range(50):
        (tmp_path / f'Model{number}').touch()
    usage = Usage()
    lookups = file_lookups(usage, PLACE)
    assert lookups.entries(str(tmp_path))['model7'] == 'Model7'
    assert used(usage) == 50
    monkeypatch.setattr(counted.os, 'listdir', None)
    assert len(lookups.entries(str(tmp_path))) == 50


@pytest.mark.parametrize('name', ['none', 'file', 'a\0'])
def test_what_is_no_directory_has_no_entries(tmp_path, name):
    (tmp_path / 'file').touch()
    assert file_lookups().entries(f'{tmp_path}/{name}') == {}
