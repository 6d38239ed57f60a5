# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Calls in a real process of their own: its limits, and how it ends."""

import os
from pathlib import Path
import select
import signal
import subprocess
import sys
import threading
import time

import pytest

from sdf_pose_bridge import limited_process
from sdf_pose_bridge.limited_process import (
    Allowance,
    LimitedProcess,
    LimitExceededError,
    ProcessEndedError,
)

DEADLINE_S = 60.0
AMPLE = Allowance(memory_bytes=2_000_000_000, processor_s=DEADLINE_S, wall_s=DEADLINE_S)
SPIN = 'while True: pass'
GROW = 'kept = []\nwhile True: kept.append(bytearray(1_000_000))'
MEGABYTES = 20


@pytest.fixture(name='limited')
def make_process():
    """Makes processes; ``limited(**changes)`` has all limits of ``AMPLE`` but for these."""
    made = []

    def make(**changes):
        made.append(LimitedProcess(AMPLE._replace(**changes)))
        return made[-1]

    yield make
    for each in made:
        each.close()


def has_ended(pid):
    """Return whether a process ends before the deadline."""
    try:
        descriptor = os.pidfd_open(pid)
    except ProcessLookupError:
        return True
    return bool(select.select([descriptor], [], [], DEADLINE_S)[0])


def test_a_function_is_called_in_another_process(limited):
    process = limited()
    pid = process.call(os.getpid)
    assert pid != os.getpid()
    assert process.call(os.getpid) == pid
    assert process.call(pow, 2, 10) == 1024


def test_an_exception_is_raised_here_with_its_traceback(limited):
    process = limited()
    with pytest.raises(ZeroDivisionError) as caught:
        process.call(divmod, 1, 0)
    assert 'divmod' not in str(caught.value)
    assert 'in _answer' in str(caught.value.__cause__)
    assert process.call(pow, 2, 2) == 4


def test_an_exception_that_cannot_be_pickled(limited):
    text = 'class Odd(Exception): pass\nraise Odd("why")'
    with pytest.raises(RuntimeError, match=r"Odd\('why'\)"):
        limited().call(exec, text, {})


def test_what_is_printed_does_not_come_between_the_answers(limited):
    process = limited()
    process.call(print, 'to nobody', 0)
    assert process.call(pow, 2, 2) == 4


def test_much_can_be_sent_both_ways(limited):
    text = 'x' * 10_000_000
    assert limited().call(str.upper, text) == text.upper()


@pytest.mark.parametrize(('changes', 'code', 'message'), [
    ({'memory_bytes': 200_000_000}, GROW, 'more than 200 MB of memory'),
    ({'processor_s': 0.5}, SPIN, 'more than 0.5 s of processor time'),
    ({'wall_s': 0.5}, 'import time; time.sleep(1000)', 'more than 0.5 s'),
])
def test_a_call_that_exceeds_a_limit_is_ended(limited, changes, code, message):
    process = limited(**changes)
    pid = process.call(os.getpid)
    with pytest.raises(LimitExceededError) as caught:
        process.call(exec, code, {})
    assert str(caught.value) == message
    assert has_ended(pid)
    assert process.call(pow, 2, 2) == 4


def test_one_huge_array_fails_at_once(limited):
    process = limited(address_space_bytes=1_000_000_000)
    with pytest.raises(LimitExceededError, match='more than 1000 MB of memory'):
        process.call(bytearray, 1_500_000_000)
    assert process.call(len, bytes(1000)) == 1000


def test_a_process_without_memory_ends(limited):
    process = limited()
    pid = process.call(os.getpid)
    with pytest.raises(MemoryError):
        process.call(bytes, 1 << 62)
    assert has_ended(pid)


def test_whoever_reads_more_may_use_more(limited, tmp_path):
    file = tmp_path / 'file'
    file.write_bytes(bytes(MEGABYTES * 1_000_000))
    code = (
        f'open({str(file)!r}, "rb").read(); kept = b"1" * 300_000_000; '
        'import time; time.sleep(0.3)')
    little = {'memory_bytes': 100_000_000}
    limited(**little, memory_bytes_per_megabyte=20_000_000).call(exec, code, {})
    with pytest.raises(LimitExceededError):
        limited(**little).call(exec, code, {})


def test_other_threads_run_while_much_is_answered(limited):
    process = limited()
    process.call(pow, 2, 2)
    longest, has_answer = 0.0, threading.Event()

    def wait():
        nonlocal longest
        while not has_answer.is_set():
            begin = time.monotonic()
            time.sleep(0.0001)
            longest = max(longest, time.monotonic() - begin)

    thread = threading.Thread(target=wait)
    begin = time.monotonic()
    thread.start()
    process.call(eval, '[str(each) for each in range(2_000_000)]', {})
    seconds = time.monotonic() - begin
    has_answer.set()
    thread.join()
    assert longest < 0.25 * seconds


def test_an_interrupt_by_the_keyboard_is_not_for_it(limited):
    process, mask = limited(), signal.pthread_sigmask(signal.SIG_BLOCK, [])
    pid = process.call(os.getpid)
    os.kill(pid, signal.SIGINT)
    assert process.call(os.getpid) == pid
    assert signal.pthread_sigmask(signal.SIG_BLOCK, []) == mask


def test_a_process_that_is_killed_while_it_is_busy_is_an_error(limited):
    process = limited()
    pid = process.call(os.getpid)
    threading.Timer(0.2, os.kill, (pid, signal.SIGKILL)).start()
    with pytest.raises(ProcessEndedError, match='has ended by signal 9') as caught:
        process.call(exec, SPIN, {})
    assert caught.value.may_pass
    assert process.call(pow, 2, 2) == 4


@pytest.mark.parametrize(('code', 'message'), [
    ('import os; os.abort()', 'has ended by signal 6'),
    ('import os; os._exit(3)', 'has ended with exit code 3'),
])
def test_a_process_that_ends_itself_would_do_so_again(limited, code, message):
    with pytest.raises(ProcessEndedError, match=message) as caught:
        limited().call(exec, code, {})
    assert not caught.value.may_pass


def test_a_process_that_has_ended_between_two_calls_is_replaced(limited):
    process = limited()
    pid = process.call(os.getpid)
    os.kill(pid, signal.SIGKILL)
    assert has_ended(pid)
    assert process.call(pow, 2, 2) == 4


def test_a_process_that_is_killed_before_it_reads_a_call_is_replaced(limited):
    process = limited()
    pid = process.call(os.getpid)
    os.kill(pid, signal.SIGSTOP)
    threading.Timer(0.2, os.kill, (pid, signal.SIGKILL)).start()
    assert process.call(pow, 2, 2) == 4


def test_a_process_that_cannot_be_started_is_an_error_that_passes(limited, monkeypatch):
    process = limited()
    monkeypatch.setattr(sys, 'executable', '/none/python')
    with pytest.raises(ProcessEndedError, match=r'cannot be started.*No such file') as caught:
        process.call(pow, 2, 2)
    assert caught.value.may_pass
    monkeypatch.undo()
    assert process.call(pow, 2, 2) == 4


def test_a_process_that_is_not_needed_for_a_while_ends(limited, monkeypatch):
    monkeypatch.setattr(limited_process, 'KEPT_S', 0.1)
    process = limited()
    pid = process.call(os.getpid)
    assert has_ended(pid)
    monkeypatch.undo()
    assert process.call(os.getpid) != pid


def test_a_process_that_would_keep_much_memory_ends(limited):
    process = limited()
    pid = process.call(os.getpid)
    process.call(exec, 'import sys; sys.kept = b"1" * 300_000_000', {})
    assert has_ended(pid)


def test_a_closed_process_has_ended(limited):
    process = limited()
    pid = process.call(os.getpid)
    process.close()
    assert not Path(f'/proc/{pid}').exists()
    process.close()


PARENT = """
import os, sys, threading
from sdf_pose_bridge.limited_process import Allowance, LimitedProcess
process = LimitedProcess(Allowance(10**9, 60.0, 60.0))
print(process.call(os.getpid), flush=True)
threading.Thread(target=process.call, args=(exec, {code!r}, {{}}), daemon=True).start()
sys.stdin.read()
"""


@pytest.mark.parametrize('code', [SPIN, 'sum(range(10**12))', 'pass'])
@pytest.mark.parametrize('number', [signal.SIGKILL, signal.SIGTERM])
def test_the_process_ends_with_the_one_that_has_started_it(code, number):
    parent = subprocess.Popen(
        [sys.executable, '-c', PARENT.format(code=code)], stdin=subprocess.PIPE,
        stdout=subprocess.PIPE, text=True)
    pid = int(parent.stdout.readline())
    parent.send_signal(number)
    parent.communicate()
    assert has_ended(pid)


def test_the_process_imports_what_the_one_that_starts_it_would(limited, tmp_path, monkeypatch):
    (tmp_path / 'only_here.py').write_text('from os import getpid')
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ImportError):
        limited().call(exec, 'import only_here', {})
    monkeypatch.syspath_prepend(tmp_path)
    limited().call(exec, 'import only_here', {})
