# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Files that a process of its own reads: its answers, its limits, and what ends it."""

import os
import signal

import pytest
from sdf_texts import model_file, world_file

from sdf_pose_bridge.errors import (
    AddressError,
    FileReadError,
    LimitError,
    SdfError,
    TemporaryReadError,
)
from sdf_pose_bridge.export.pose_setting import write_frame_change
from sdf_pose_bridge.export.published_scene import fingerprint_of_scene, LoadRequest
from sdf_pose_bridge.export.visual_markers import markers_from_text
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.ros.file_process import loaded_scene

CRASH = """import faulthandler, signal
faulthandler.disable()
signal.raise_signal(signal.SIGSEGV)"""
LINK = """<link name="l"><pose>1 0 0 0 0 0</pose>
  <visual name="v"><geometry><box/></geometry></visual></link>"""


@pytest.fixture
def path(tmp_path):
    path = tmp_path / 'cell.sdf'
    path.write_text(model_file(LINK))
    return path


@pytest.fixture
def request_of_file(path):
    return LoadRequest(str(path), '')


def result(reader, request, function, *arguments):
    with reader.calling(request, function, *arguments) as call:
        return call.result()


def load(reader, request):
    return result(reader, request, loaded_scene, request)


def test_a_scene_comes_from_another_process(reader, request_of_file, path):
    loaded = load(reader, request_of_file)
    assert loaded.path == path
    assert loaded.lookup.pose('l').pose == Pose(1.0)
    assert result(reader, request_of_file, os.getpid) != os.getpid()


def test_markers_come_from_it_and_changes_are_written_there(reader, request_of_file, path):
    loaded = load(reader, request_of_file)
    fingerprint = fingerprint_of_scene(loaded.scene)
    (marker,), _ = result(reader,
        loaded.request, markers_from_text, loaded.text, loaded.path, loaded.request, fingerprint)
    assert marker.type == 'CUBE'
    change = result(
        reader, loaded.request, write_frame_change, loaded.request, fingerprint, 'l', Pose(2.0),
        '', loaded.joint_positions, False)
    assert '+<sdf' in change.diff or '<pose>2 0 0 0 0 0' in change.diff
    assert path.read_text() == model_file(LINK).replace('1 0 0', '2 0 0')


def test_all_errors_of_a_file_arrive(reader, path, request_of_file):
    path.write_text(world_file('<model name="m"/><frame name="f" attached_to="x"/>'))
    with pytest.raises(SdfError) as caught:
        load(reader, request_of_file)
    assert {error.code for error in caught.value.errors} == {
        'MODEL_WITHOUT_LINK', 'FRAME_ATTACHED_TO_INVALID'}
    assert {error.place.file for error in caught.value.errors} == {str(path)}


def test_a_uri_without_a_file_is_an_error(reader):
    with pytest.raises(AddressError):
        load(reader, LoadRequest('package://no_such_package/cell.sdf', ''))


def test_a_file_that_needs_too_much_is_an_error(reader, request_of_file):
    with pytest.raises(LimitError) as caught:
        result(reader, request_of_file, bytearray, 2_000_000_000)
    assert str(caught.value) == (
        f'{request_of_file.sdf_file}: LIMIT: the file needs more than 700 MB of memory to be read')


def test_a_process_that_is_killed_is_an_error_that_passes(reader, request_of_file):
    with pytest.raises(TemporaryReadError, match='has ended by signal 9'):
        result(reader, request_of_file, signal.raise_signal, signal.SIGKILL)
    assert load(reader, request_of_file)


def test_a_process_that_crashes_is_an_error_that_stays(reader, request_of_file):
    with pytest.raises(FileReadError, match='has ended by signal 11') as caught:
        result(reader, request_of_file, exec, CRASH, {})
    assert not isinstance(caught.value, TemporaryReadError)


