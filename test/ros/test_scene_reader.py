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
    PassingReadError,
    SdfError,
)
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.tf.loaded_scene import fingerprint_of_scene, LoadRequest, may_pass
from sdf_pose_bridge.tf.loading import frame_change_from_request
from sdf_pose_bridge.tf.visual_markers import markers_from_text

CRASH = """import faulthandler, signal
faulthandler.disable()
signal.raise_signal(signal.SIGSEGV)"""
LINK = """<link name="l"><pose>1 0 0 0 0 0</pose>
  <visual name="v"><geometry><box/></geometry></visual></link>"""


@pytest.fixture(name='path')
def write_file(tmp_path):
    path = tmp_path / 'cell.sdf'
    path.write_text(model_file(LINK), encoding='utf-8')
    return path


@pytest.fixture(name='request_of_file')
def make_request(path):
    return LoadRequest(str(path), '')


def change_of(loaded):
    """Return the call that finds a change."""
    return (
        frame_change_from_request, loaded.request, fingerprint_of_scene(loaded.scene), 'l',
        Pose(2.0), '', loaded.joint_positions)


def test_a_scene_comes_from_another_process(reader, request_of_file, path):
    loaded = reader.loaded_scene(request_of_file)
    assert loaded.path == path
    assert loaded.lookup.pose('l').pose == Pose(1.0)
    assert reader.result(request_of_file, os.getpid) != os.getpid()


def test_markers_and_changes_come_from_it_too(reader, request_of_file):
    loaded = reader.loaded_scene(request_of_file)
    fingerprint = fingerprint_of_scene(loaded.scene)
    (marker,), _ = reader.result(
        loaded.request, markers_from_text, loaded.text, loaded.path, loaded.request, fingerprint)
    assert marker.type == 'CUBE'
    change = reader.result(loaded.request, *change_of(loaded))
    assert '+<sdf' in change.diff or '<pose>2 0 0 0 0 0' in change.diff
    assert change.file.new_text.decode() == model_file(LINK).replace('1 0 0', '2 0 0')


def test_a_change_of_a_file_that_has_changed_is_refused(reader, request_of_file, path):
    loaded = reader.loaded_scene(request_of_file)
    path.write_text(model_file(LINK.replace('1 0 0', '1 2 0')), encoding='utf-8')
    with pytest.raises(SdfError, match='the file has changed since it was read'):
        reader.result(loaded.request, *change_of(loaded))


def test_all_errors_of_a_file_arrive(reader, path, request_of_file):
    path.write_text(world_file('<model name="m"/><frame name="f" attached_to="x"/>'))
    with pytest.raises(SdfError) as caught:
        reader.loaded_scene(request_of_file)
    assert {error.code for error in caught.value.errors} == {
        'MODEL_WITHOUT_LINK', 'FRAME_ATTACHED_TO_INVALID'}
    assert {error.place.file for error in caught.value.errors} == {str(path)}


def test_a_uri_without_a_file_is_an_error(reader):
    with pytest.raises(AddressError):
        reader.loaded_scene(LoadRequest('package://no_such_package/cell.sdf', ''))


def test_a_file_that_needs_too_much_is_an_error(reader, request_of_file):
    with pytest.raises(LimitError) as caught:
        reader.result(request_of_file, bytearray, 2_000_000_000)
    assert str(caught.value) == (
        f'{request_of_file.sdf_file}: LIMIT: the file needs more than 700 MB of memory to be read')
    assert not may_pass(caught.value)


def test_a_process_that_is_killed_is_an_error_that_passes(reader, request_of_file):
    with pytest.raises(PassingReadError, match='has ended by signal 9') as caught:
        reader.result(request_of_file, signal.raise_signal, signal.SIGKILL)
    assert may_pass(caught.value)
    assert reader.loaded_scene(request_of_file)


def test_a_process_that_crashes_is_an_error_that_stays(reader, request_of_file):
    with pytest.raises(FileReadError, match='has ended by signal 11') as caught:
        reader.result(request_of_file, exec, CRASH, {})
    assert not may_pass(caught.value)


