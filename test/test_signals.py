# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Signals end every command as they end programs in C, at any place, and nothing is left."""

import os
import select
import signal
import subprocess

from command_line import AS_MODULE, COMMAND, completed, ENVIRONMENT
from commands import ARGUMENTS, COMMANDS
from deadline import DEADLINE_S
import pytest
from sdf_texts import LINK, model_file
from signal_places import with_signals_at

READY = 'resource.setrlimit 9'
"""The command begins, where it limits its memory; or, for ``view``, that of another process."""

NUMBERS = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]


@pytest.fixture
def ended(tmp_path):
    """Runs a command that gets a signal; returns it when all of its processes have ended."""
    (tmp_path / 'm.sdf').write_text(model_file(LINK))
    before = [*tmp_path.iterdir()]

    def run(command, place, number, **options):
        reader, writer = os.pipe()
        with os.fdopen(reader, 'rb') as ends:
            done = completed(
                command, cwd=tmp_path, stdin=subprocess.DEVNULL, pass_fds=[writer],
                env=with_signals_at(
                    place, [number], tmp_path, {**ENVIRONMENT, 'TMPDIR': str(tmp_path)},
                    **options))
            os.close(writer)
            assert select.select([ends], [], [], DEADLINE_S)[0]
            assert ends.read() == b''
        left = {*tmp_path.iterdir()} - {*before, tmp_path / 'sitecustomize.py'}
        assert {path.name for path in left} <= {'__pycache__'}
        return done.returncode, done.stdout, done.stderr
    return run


@pytest.mark.parametrize('name', COMMANDS)
def test_a_command_is_interrupted_by_ctrl_c(ended, name):
    if name == 'view':
        pytest.importorskip('viser', reason='needs viser')
    done = ended([*COMMAND, name, *ARGUMENTS[name]], READY, signal.SIGINT)
    assert done == (-signal.SIGINT, '', '')


@pytest.mark.parametrize('number', NUMBERS)
@pytest.mark.parametrize('place', ['import sdf_pose_bridge.cli.main', 'import numpy', READY])
@pytest.mark.parametrize('command', [COMMAND, AS_MODULE], ids=['executable', 'module'])
def test_each_signal_ends_it_in_silence(ended, command, place, number):
    assert ended([*command, 'check', 'm.sdf'], place, number) == (-number, '', '')


@pytest.mark.parametrize('module', ['viser', 'trimesh', 'websockets'])
def test_libraries_of_the_viewer_do_not_keep_it_from_ending(ended, module):
    pytest.importorskip(module, reason=f'needs {module}')
    done = ended([*COMMAND, 'view', *ARGUMENTS['view']], f'import {module}', signal.SIGINT)
    assert done == (-signal.SIGINT, '', '')


def test_the_first_line_of_the_executable_comes_before_its_imports(ended):
    if COMMAND is AS_MODULE or 'lib' not in COMMAND[0]:
        pytest.skip('needs a ROS workspace')
    done = ended([*COMMAND, 'check', 'm.sdf'], 'import sdf_pose_bridge', signal.SIGINT)
    assert done == (-signal.SIGINT, '', '')


@pytest.mark.parametrize('number', NUMBERS)
def test_ignored_signals_are_ignored(ended, number):
    code, _, _ = ended([*COMMAND, 'check', 'm.sdf'], READY, number, are_ignored='yes')
    assert code == 0
