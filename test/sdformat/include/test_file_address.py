# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Addresses of files: wrong ones are refused with the reason, others become absolute paths."""

from pathlib import Path

import pytest

from sdf_pose_bridge.sdformat.include.file_address import AddressError
from sdf_pose_bridge.sdformat.include.file_address import path_from_address

INSTALLED = {'cell_description': '/opt/cell/share/cell_description'}
MODELS = {'model://table': '/models/table'}


def path_from(address):
    return path_from_address(address, INSTALLED.__getitem__, MODELS.get)


@pytest.mark.parametrize(('address', 'reason'), [
    ('package://nowhere/cell.sdf', 'names the package "nowhere", which is not installed'),
    ('package:///cell.sdf', 'names the package ""'),
    ('model://chair', 'is found neither in resource_paths nor in'),
    ('http://example.org/cell.sdf', 'is a http:// URI'),
    ('file://cells/cell.sdf', 'names the host "cells"'),
    ('file:///cell.sdf?x=1', r'write %3F or %23'),
    ('file:///cell#2.sdf', r'write %3F or %23'),
    ('file://[cell.sdf', 'is no URI'),
])
def test_what_names_no_file_is_refused(address, reason):
    with pytest.raises(AddressError, match=reason) as refusal:
        path_from(address)
    assert f'"{address}"' in str(refusal.value)


@pytest.mark.parametrize(('address', 'path'), [
    ('/cells/cell.sdf', '/cells/cell.sdf'),
    ('/cells/50%25 #2?.sdf', '/cells/50%25 #2?.sdf'),
    ('file:///cells/cell.sdf', '/cells/cell.sdf'),
    ('file://localhost/cells/cell.sdf', '/cells/cell.sdf'),
    ('file:///cells/left%20cell%23.sdf', '/cells/left cell#.sdf'),
    ('model://table', '/models/table'),
    ('package://cell_description/worlds/cell.sdf',
     '/opt/cell/share/cell_description/worlds/cell.sdf'),
])
def test_what_names_a_file_becomes_its_path(address, path):
    assert path_from(address) == Path(path)


def test_a_relative_path_starts_at_the_working_directory(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    assert path_from('cell.sdf') == tmp_path / 'cell.sdf'


def test_a_tilde_is_the_home_directory(monkeypatch):
    monkeypatch.setenv('HOME', '/home/someone')
    assert path_from('~/cell.sdf') == Path('/home/someone/cell.sdf')
