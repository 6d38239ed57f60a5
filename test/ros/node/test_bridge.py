# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The executable without ROS around it: what is missing is said in one sentence."""

import sys

from command_line import completed
from folders import ROOT
import pytest

from sdf_pose_bridge.ros.node.bridge import LINK_COMMAND, sentence_from_import_error


@pytest.mark.parametrize(('module', 'words'), [
    ('sdf_pose_bridge_interfaces', LINK_COMMAND),
    ('rclpy', 'the Python module rclpy is missing')])
def test_without_a_module_it_says_what_to_do(module, words):
    program = (
        f'import sys; sys.modules[{module!r}] = None\n'
        'from sdf_pose_bridge.ros.node.bridge import main\n'
        'sys.exit(main(["bridge"]))')
    result = completed([sys.executable, '-c', program], cwd=ROOT)
    assert result.returncode == 1
    assert words in result.stderr
    assert len(result.stderr.splitlines()) == 1


@pytest.mark.parametrize(('error', 'sentence'), [
    (ModuleNotFoundError('No module named x', name='sdf_pose_bridge_interfaces.srv'),
     LINK_COMMAND),
    (ModuleNotFoundError('No module named x', name='tf2_msgs.msg'),
     'the Python module tf2_msgs is missing'),
    (ModuleNotFoundError('No module named x', name='lxml'), 'rosdep install'),
    (ImportError('librcl.so: cannot open shared object file\nmore', name='rclpy._rclpy'),
     'cannot be loaded: librcl.so: cannot open shared object file'),
])
def test_a_failed_import_is_one_sentence(error, sentence):
    text = sentence_from_import_error(error)
    assert sentence in text
    assert '\n' not in text


def test_the_readme_says_the_same_words():
    assert LINK_COMMAND in (ROOT / 'README.md').read_text()


# Each of these takes milliseconds to import, or what imports it does.
WAITS_FOR_THE_FIRST_MESSAGE = (
    'sdf_pose_bridge.ros.node.node', 'sdf_pose_bridge.ros.node.services',
    'sdf_pose_bridge.ros.publishing.diagnostics', 'diagnostic_msgs', 'std_srvs', 'hashlib',
    'importlib.metadata', 'numpy.ma')


def test_what_can_wait_for_the_first_message_is_not_imported_before():
    pytest.importorskip('rclpy', reason='needs ROS 2')
    program = (
        # numpy 1 imports all of itself.
        'import sys\n'
        'import numpy\n'
        'imported_by_numpy = set(sys.modules)\n'
        'import sdf_pose_bridge.ros.node.process\n'
        'from sdf_pose_bridge import load\n'
        'from sdf_pose_bridge.ros.cdr import StampedRecords\n'
        'from sdf_pose_bridge.tf.tree import tf_tree_from_scene\n'
        'tree = tf_tree_from_scene(load("examples/work_cell.sdf"))\n'
        'StampedRecords([tree.parent_ids, tree.frame_ids], tree.transforms).tf_message()\n'
        'imported = set(sys.modules) - imported_by_numpy\n'
        f'print([name for name in {WAITS_FOR_THE_FIRST_MESSAGE} if name in imported])')
    result = completed([sys.executable, '-c', program], cwd=ROOT, check=True)
    assert result.stdout.strip() == '[]'
