# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose urdf``: what is written where, and what is wrong."""

import pytest
from sdf_texts import model_file, world_file

ARM = model_file(
    '<link name="base"><visual name="v"><geometry><plane/></geometry></visual></link>'
    '<link name="hand"/><frame name="tip" attached_to="hand"/>'
    '<joint name="elbow" type="revolute"><parent>base</parent><child>hand</child></joint>')
CELL = world_file("""
    <model name="table"><link name="l"/></model>
    <model name="robot"><link name="l"/></model>""")


@pytest.fixture(autouse=True)
def write_files(files):
    """The folder has an arm and a cell with two models."""
    (files / 'arm.sdf').write_text(ARM)
    (files / 'cell.sdf').write_text(CELL)


def test_urdf_is_printed_and_warnings_beside_it(run_main):
    result = run_main('urdf', 'arm.sdf')
    assert result.returncode == 0
    assert result.stdout.startswith('<?xml version="1.0"?>\n<robot name="m">\n')
    assert 'joint name="elbow" type="continuous"' in result.stdout
    assert 'the visual "m::base::v" is left out: URDF has no plane' in result.stderr


def test_urdf_is_written_to_a_file(run_main, files):
    printed = run_main('urdf', 'arm.sdf').stdout
    assert run_main('urdf', 'arm.sdf', '-o', 'arm.urdf').stdout == ''
    assert (files / 'arm.urdf').read_text() == printed


def test_kinds_and_names(run_main):
    text = run_main('urdf', 'arm.sdf', '--kinds', 'frame', '--frame-names', 'scoped',
                    '--frame-separator', '_').stdout
    assert 'link name="m_tip"' in text
    assert 'link name="m"' not in text


def test_model_of_a_world(run_main):
    assert '<robot name="table">' in run_main('urdf', 'cell.sdf', '--model', 'table').stdout
