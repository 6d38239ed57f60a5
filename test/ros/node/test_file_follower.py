# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""When files are read again, and when a failure is reported."""

import pytest

from sdf_pose_bridge.errors import Place, SdfError, TemporaryReadError
from sdf_pose_bridge.export.published_scene import LoadRequest
from sdf_pose_bridge.export.scene_from_request import files_behind_error, loaded_scene_from_request
from sdf_pose_bridge.ros.node import file_follower
from sdf_pose_bridge.ros.node.file_follower import FileFollower

GOOD = '<sdf version="1.10"><model name="m"><link name="l"/></model></sdf>'
BUSY, BROKEN = TemporaryReadError('busy', Place('a.sdf')), SdfError('broken', Place('a.sdf'))
HALF, LONGER_HALF = GOOD[:40], '\n' + GOOD[:50]


@pytest.fixture
def file(tmp_path):
    path = tmp_path / 'scene.sdf'
    path.write_text(GOOD)
    return path


@pytest.fixture
def request_of_file(file):
    return LoadRequest(str(file), '')


@pytest.fixture
def follower(request_of_file):
    follower = FileFollower(loaded_scene_from_request(request_of_file))
    follower.has_to_read()  # the file was written just now
    return follower


@pytest.fixture
def reported(follower, request_of_file):
    """The errors that are reported in a period, in which the file is read if need be."""
    def report():
        failure = None
        if follower.has_to_read():
            failure = []
            try:
                follower.follow(loaded_scene_from_request(request_of_file))
            except SdfError as error:
                follower.follow_error(error, files_behind_error(error, request_of_file))
                failure = [str(error)]
        return follower.failure_of_period(failure)
    return report


def test_a_failure_is_reported_once_the_file_no_longer_changes(follower, file, reported):
    file.write_text(HALF)
    assert reported() == []
    file.write_text(LONGER_HALF)
    assert reported() == [], 'as it has changed again'
    (line,) = reported()
    assert f'{file}:2: ' in line
    assert reported() == [], 'as it was'


def test_a_failure_that_occurs_twice_is_reported(file, reported):
    file.write_text(HALF)
    assert reported() == []
    file.write_text(f'{HALF} ')
    assert len(reported()) == 1


def test_a_failure_that_vanishes_is_not_reported(follower, file, reported):
    file.write_text(HALF)
    assert reported() == []
    file.write_text(GOOD)
    assert reported() == []
    assert reported() == []


def test_a_failure_is_reported_again_after_a_success(file, reported):
    for _ in range(2):
        file.write_text(HALF)
        assert reported() == []
        assert len(reported()) == 1
        file.write_text(GOOD)
        assert reported() == []


def test_a_failure_of_a_requested_reading_is_reported_at_once(follower):
    assert follower.unreported(['broken']) == ['broken']
    assert follower.unreported(['broken']) == []
    assert follower.failure_of_period(None) == []


def test_a_file_behind_an_error_is_followed(follower, tmp_path):
    path = tmp_path / 'included.sdf'
    follower.follow_error(BROKEN, [str(path)])
    assert not follower.has_to_read()
    path.write_text(GOOD)
    assert follower.has_to_read()
    assert not follower.has_to_read()


def test_a_change_before_files_are_read_again_is_read_once(follower, file, monkeypatch):
    monkeypatch.setattr(file_follower, 'RETRY_PERIOD_S', 0.0)
    follower.follow_error(BUSY, [])
    file.write_text(HALF)
    assert follower.has_to_read()
    follower.follow_error(BROKEN, [])
    assert not follower.has_to_read()


@pytest.mark.parametrize(('error', 'is_retried'), [
    (BUSY, True), (BROKEN, False), (ZeroDivisionError(), False)])
def test_files_are_read_again_soon_after_a_temporary_failure(
        follower, request_of_file, monkeypatch, error, is_retried):
    monkeypatch.setattr(file_follower, 'RETRY_PERIOD_S', 0.0)
    follower.follow_error(error, [])
    assert follower.has_to_read() is is_retried
    follower.follow(loaded_scene_from_request(request_of_file))
    assert not follower.has_to_read()
