# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Changes of files are noticed once each, whatever way they come about."""

from functools import partial
import os
from pathlib import Path
from types import SimpleNamespace

import pytest

from sdf_pose_bridge.file_watcher import FileWatcher

LONG_AGO = 10 ** 18
LATER = 10 ** 19


@pytest.fixture
def path(tmp_path):
    path = tmp_path / 'a.sdf'
    path.write_text('old')
    return path


@pytest.fixture
def watcher(path):
    return watching(path)


def watching(path, read_since_ns=LATER):
    watcher = FileWatcher()
    watcher.watch([str(path)], read_since_ns)
    return watcher


def rewrite(path):
    path.write_text('longer')


def replace(path):
    new = path.with_suffix('.new')
    new.write_text('new')
    new.replace(path)


def keep_size_and_time(path, change):
    status = path.stat()
    change(path)
    assert path.stat().st_size == status.st_size
    os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))


def become_a_link(path):
    other = path.with_name('b.sdf')
    other.write_text('old')
    path.unlink()
    path.symlink_to(other)


CHANGES = pytest.mark.parametrize('change', [
    rewrite, replace, partial(keep_size_and_time, change=replace),
    partial(keep_size_and_time, change=lambda path: path.write_text('new')), Path.unlink,
    lambda path: path.chmod(0), become_a_link])


def test_without_a_change_there_is_nothing_to_notice(watcher):
    assert not watcher.notices_change()


@CHANGES
def test_a_change_is_noticed_once(watcher, path, change):
    change(path)
    assert watcher.notices_change()
    assert not watcher.notices_change()


def test_a_file_that_appears_is_noticed(tmp_path):
    path = tmp_path / 'later.sdf'
    watcher = watching(path, LONG_AGO)
    assert not watcher.notices_change()
    path.touch()
    assert watcher.notices_change()


def test_a_link_that_points_elsewhere_is_noticed(tmp_path, path):
    link, other = tmp_path / 'link.sdf', tmp_path / 'other.sdf'
    other.write_text('old')
    link.symlink_to(path)
    watcher = watching(link)
    link.unlink()
    link.symlink_to(other)
    assert watcher.notices_change()


def test_other_files_are_watched_no_longer(watcher, path):
    watcher.watch([], LATER)
    rewrite(path)
    assert not watcher.notices_change()


def test_a_file_that_changed_while_it_was_read_counts_as_changed_once(path):
    read_since_ns = path.stat().st_ctime_ns - 1
    watcher = watching(path, read_since_ns)
    assert watcher.notices_change()
    watcher.watch([str(path)], read_since_ns)
    assert not watcher.notices_change()


def test_a_file_that_changed_in_the_same_tick_as_the_reading_began_counts_as_changed(path):
    assert watching(path, path.stat().st_ctime_ns + 1).notices_change()


def test_a_time_that_lies_ahead_does_not_make_a_file_change_for_ever(path):
    watcher = FileWatcher()
    for _ in range(2):
        watcher.watch([str(path)], LONG_AGO)
        watcher.notices_change()
    watcher.watch([str(path)], LONG_AGO)
    assert not watcher.notices_change()


def test_a_second_change_with_the_same_time_is_noticed_where_times_are_whole_seconds(
        path, monkeypatch):
    now_ns = path.stat().st_ctime_ns
    second_ns = now_ns - now_ns % 10**9
    status = SimpleNamespace(
        st_dev=1, st_ino=1, st_size=1, st_mtime_ns=second_ns, st_ctime_ns=second_ns)
    monkeypatch.setattr('os.stat', lambda _path: status)
    monkeypatch.setattr('time.time_ns', lambda: now_ns)
    watcher = watching(path)
    assert not watcher.notices_change()
    now_ns += 2 * 10**9
    assert watcher.notices_change()
    assert not watcher.notices_change()


def test_more_files_can_be_watched_until_the_next_choice(watcher, path, tmp_path):
    watcher.watch_also([str(tmp_path / 'models'), str(path)])
    assert not watcher.notices_change()
    (tmp_path / 'models').mkdir()
    assert watcher.notices_change()
    (tmp_path / 'models' / 'box').mkdir()
    assert watcher.notices_change()
    watcher.watch([str(path)], LATER)
    (tmp_path / 'models' / 'crate').mkdir()
    assert not watcher.notices_change()


def test_to_watch_more_forgets_no_change(watcher, path):
    rewrite(path)
    watcher.watch_also([str(path)])
    assert watcher.notices_change()


@pytest.mark.parametrize('name', ['', '\0', 'a' * 5000, '\udcff'])
def test_a_path_that_cannot_exist_is_a_file_that_is_not_there(name):
    watcher = FileWatcher()
    watcher.watch([name, f'{name}/x'], LONG_AGO)
    assert not watcher.notices_change() or not name
