# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""How a process ends that cannot go on."""

import sys

from command_line import completed
import pytest

PROGRAM = """
import sys, threading
from sdf_pose_bridge.ros.node.ending import end_at_failures_of_threads, end_without_memory

class Fails:
    def __del__(self):
        raise {error}

def fail():
    raise {error}

end_at_failures_of_threads()
{code}
print('goes on')
"""
IN_THREAD = 'thread = threading.Thread(target=fail); thread.start(); thread.join()'
NO_MEMORY = 'sdf_pose_bridge: there is not enough memory, so the node ends\n'


def ended(code, error):
    return completed([sys.executable, '-c', PROGRAM.format(code=code, error=error)])


@pytest.mark.parametrize('code', [IN_THREAD, 'Fails()', 'end_without_memory()'])
def test_without_memory_the_process_ends_with_one_line(code):
    done = ended(code, 'MemoryError')
    assert (done.returncode, done.stdout, done.stderr) == (1, '', NO_MEMORY)


def test_without_memory_for_the_hook_of_threads_the_process_ends():
    done = ended(f'threading.ExceptHookArgs = lambda _: fail(); {IN_THREAD}', 'MemoryError')
    assert (done.returncode, done.stdout) == (1, '')
    assert done.stderr.endswith(NO_MEMORY)


def test_a_thread_that_fails_ends_the_process_with_a_traceback():
    done = ended(IN_THREAD, r'ValueError("\x1b[2J\n[FATAL] why")')
    assert done.returncode == 1
    first, second, *lines = done.stderr.splitlines()
    assert first.endswith('has failed, so the node ends')
    assert second == '    Traceback (most recent call last):'
    assert lines[-2:] == [r'    ValueError: \x1b[2J', '    [FATAL] why']


@pytest.mark.parametrize('module', ['builtins', 'sdf_pose_bridge.ros.log_lines', '__main__'])
def test_objects_that_are_destroyed_when_python_ends_change_nothing(module):
    done = ended(f'import {module}; {module}.kept = Fails()', 'ValueError')
    assert (done.returncode, done.stdout, done.stderr) == (0, 'goes on\n', '')


@pytest.mark.parametrize(('code', 'error'), [
    (IN_THREAD, 'SystemExit'), ('Fails()', r'ValueError("\x1b[2J")')])
def test_other_ends_of_a_thread_and_defects_that_python_reports_end_nothing(code, error):
    done = ended(code, error)
    assert (done.returncode, done.stdout) == (0, 'goes on\n')
    assert '\x1b' not in done.stderr
