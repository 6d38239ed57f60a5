# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Changes of files are noticed once each, whatever way they come about."""

import os
import threading

import pytest

from sdf_pose_bridge.ros import file_watcher as file_watch
from sdf_pose_bridge.ros.file_watcher import FileWatch
from sdf_pose_bridge.ros.file_watcher import Watchman

LONG_AGO = 10 ** 18
LATER = 10 ** 19


@pytest.fixture
def path(tmp_path):
    path = tmp_path / 'a.sdf'
    path.write_text('old', encoding='utf-8')
    return path


@pytest.fixture
def watch(path):
    watch = FileWatch()
    watch.watch([str(path)], LATER)
    return watch


def rewrite(path):
    path.write_text('longer', encoding='utf-8')


def replace(path):
    new = path.with_suffix('.new')
    new.write_text('new', encoding='utf-8')
    new.replace(path)


def replace_keeping_size_and_time(path):
    status = path.stat()
    replace(path)
    os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))


def rewrite_keeping_size_and_time(path):
    status = path.stat()
    path.write_text('new', encoding='utf-8')
    os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))


def delete(path):
    path.unlink()


def forbid(path):
    path.chmod(0)


def become_a_link(path):
    other = path.with_name('b.sdf')
    other.write_text('old', encoding='utf-8')
    path.unlink()
    path.symlink_to(other)


CHANGES = pytest.mark.parametrize('change', [
    rewrite, replace, replace_keeping_size_and_time, rewrite_keeping_size_and_time, delete, forbid,
    become_a_link])


def test_without_a_change_there_is_nothing_to_notice(watch):
    assert not watch.has_changed()


@CHANGES
def test_a_change_is_noticed_once(watch, path, change):
    change(path)
    assert watch.has_changed()
    assert not watch.has_changed()


@CHANGES
def test_a_look_without_taking_note_leaves_the_change_to_be_noticed(watch, path, change):
    assert not watch.would_differ()
    change(path)
    assert watch.would_differ()
    assert watch.has_changed()
    assert not watch.would_differ()


def test_a_file_that_appears_is_noticed(tmp_path):
    path = tmp_path / 'later.sdf'
    watch = FileWatch()
    watch.watch([str(path)], LONG_AGO)
    assert not watch.has_changed()
    path.touch()
    assert watch.has_changed()


def test_a_link_that_points_elsewhere_is_noticed(tmp_path, path):
    link, other = tmp_path / 'link.sdf', tmp_path / 'other.sdf'
    other.write_text('old', encoding='utf-8')
    link.symlink_to(path)
    watch = FileWatch()
    watch.watch([str(link)], LATER)
    link.unlink()
    link.symlink_to(other)
    assert watch.has_changed()


def test_other_files_are_watched_no_longer(watch, path):
    watch.watch([], LATER)
    rewrite(path)
    assert not watch.has_changed()


def test_a_file_that_changed_while_it_was_read_counts_as_changed_once(path):
    watch = FileWatch()
    read_since_ns = path.stat().st_ctime_ns - 1
    watch.watch([str(path)], read_since_ns)
    assert watch.has_changed()
    watch.watch([str(path)], read_since_ns)
    assert not watch.has_changed()


def test_a_file_that_changed_in_the_same_tick_as_the_reading_began_counts_as_changed(path):
    watch = FileWatch()
    watch.watch([str(path)], path.stat().st_ctime_ns + 1)
    assert watch.has_changed()


def test_a_time_that_lies_ahead_does_not_make_a_file_change_for_ever(path):
    watch = FileWatch()
    for _ in range(2):
        watch.watch([str(path)], LONG_AGO)
        watch.has_changed()
    watch.watch([str(path)], LONG_AGO)
    assert not watch.has_changed()


def test_more_files_can_be_watched_until_the_next_choice(watch, path, tmp_path):
    watch.watch_also([str(tmp_path / 'models'), str(path)])
    assert not watch.has_changed()
    (tmp_path / 'models').mkdir()
    assert watch.has_changed()
    (tmp_path / 'models' / 'box').mkdir()
    assert watch.has_changed()
    watch.watch([str(path)], LATER)
    (tmp_path / 'models' / 'crate').mkdir()
    assert not watch.has_changed()


def test_to_watch_more_forgets_no_change(watch, path):
    rewrite(path)
    watch.watch_also([str(path)])
    assert watch.has_changed()


@pytest.mark.parametrize('name', ['', '\0', 'a' * 5000, '\udcff'])
def test_a_path_that_cannot_exist_is_a_file_that_is_not_there(name):
    watch = FileWatch()
    watch.watch([name, f'{name}/x'], LONG_AGO)
    assert not watch.has_changed() or not name


@pytest.fixture
def calls(monkeypatch):
    """What a watchman that always has something to do calls; a semaphore."""
    monkeypatch.setattr(file_watch, 'PERIOD_S', 0.001)
    return threading.Semaphore(0)


def test_a_watchman_calls_once_until_told_to_go_on(calls):
    is_due = threading.Event()
    watchman = Watchman(is_due.is_set, calls.release)
    is_due.set()
    assert calls.acquire(timeout=20)
    assert not calls.acquire(timeout=0.05)
    watchman.go_on()
    assert calls.acquire(timeout=20)
    is_due.clear()
    watchman.go_on()


def test_a_watchman_with_nothing_to_do_only_looks(calls):
    looks = threading.Semaphore(0)

    def is_due():
        looks.release()
        return False

    Watchman(is_due, calls.release)
    for _ in range(3):
        assert looks.acquire(timeout=20)
    assert not calls.acquire(blocking=False)
