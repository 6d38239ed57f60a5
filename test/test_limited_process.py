# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Calls in real processes: their limits, and what happens when one is killed or stopped."""

import contextlib
import faulthandler
import os
import resource
import select
import signal
import subprocess
import sys
import threading

from deadline import DEADLINE_S
from processes import started
import pytest

from sdf_pose_bridge import limited_process
from sdf_pose_bridge.limited_process import LimitedProcess, ProcessEndedError
from sdf_pose_bridge.process_limits import Allowance, LimitExceededError

AMPLE = Allowance(processor_s=DEADLINE_S, memory_bytes=2_000_000_000)
SHORT = AMPLE._replace(processor_s=0.5)
SPIN = 'while True: pass'
GROW = 'kept = []\nwhile True: kept.append(bytearray(1_000_000))'
NO_ANSWER = r'has not answered in \d s, of which it used \d\.\d s of the processor'
STARTER_ENDED = 'the process that starts the reading of files has ended'


@pytest.fixture
def pipe():
    """Descriptors to read from and to write to, which processes inherit."""
    ends = os.pipe()
    yield ends
    for end in ends:
        os.close(end)


@pytest.fixture(name='process')
def make_process(pipe):
    process = LimitedProcess()
    yield process
    process.close()


@pytest.fixture
def lasting(process):
    """A process that still answers at the end of the test."""
    yield process
    assert process.call(AMPLE, pow, 2, 2) == 4


@pytest.fixture
def busy(process, pipe):
    """Starts a call that says when it runs; ``with busy(allowance, code) as (call, pid)``."""
    reader, writer = pipe

    @contextlib.contextmanager
    def start(allowance, code):
        code = f'import os; os.write({writer}, b"%d" % os.getpid())\n{code}'
        with process.start(allowance, exec, code, {}) as call:
            assert select.select([reader], [], [], DEADLINE_S)[0], 'the call does not begin'
            yield call, int(os.read(reader, 20))
    return start


class StopsWhenPickled:
    """An answer in whose middle the process is stopped."""

    def __reduce__(self):
        os.kill(os.getpid(), signal.SIGSTOP)
        return str, ()


def has_ended(pid):
    """Return whether a process ends before the deadline."""
    try:
        descriptor = os.pidfd_open(pid)
    except ProcessLookupError:
        return True
    try:
        return bool(select.select([descriptor], [], [], DEADLINE_S)[0])
    finally:
        os.close(descriptor)


def test_each_call_has_a_clean_process(process):
    first = process.call(AMPLE, os.getpid)
    process.call(AMPLE, exec, 'import sys; sys.kept = 1', {})
    assert not process.call(AMPLE, eval, 'hasattr(__import__("sys"), "kept")', {})
    assert process.call(AMPLE, os.getpid) not in (first, os.getpid())
    assert has_ended(first)


def test_preparations_are_made_once_in_another_process(monkeypatch):
    monkeypatch.delattr(sys, 'prepared_by', raising=False)
    process = LimitedProcess(lambda: setattr(sys, 'prepared_by', os.getpid()))
    first = process.call(AMPLE, eval, '__import__("sys").prepared_by', {})
    assert process.call(AMPLE, eval, '__import__("sys").prepared_by', {}) == first != os.getpid()
    assert not hasattr(sys, 'prepared_by')
    process.close()


def test_an_exception_is_raised_here_with_its_traceback(lasting):
    with pytest.raises(ZeroDivisionError) as caught:
        lasting.call(AMPLE, divmod, 1, 0)
    assert 'divmod' not in str(caught.value)
    assert 'in _answer' in str(caught.value.__cause__)


def test_an_exception_that_cannot_be_pickled(process):
    text = 'class Odd(Exception): pass\nraise Odd("why")'
    with pytest.raises(RuntimeError, match=r"Odd\('why'\)"):
        process.call(AMPLE, exec, text, {})


def test_much_can_be_sent_both_ways(process):
    text = 'x' * 10_000_000
    assert process.call(AMPLE, str.upper, text) == text.upper()


def test_a_call_that_has_been_started_is_answered_later(process):
    with process.start(AMPLE, pow, 2, 2) as call:
        assert process.call(AMPLE, os.getpid) != os.getpid()
        assert call.has_ended(DEADLINE_S)
        assert call.result() == 4


def test_a_call_keeps_no_other_one_waiting(process):
    with process.start(AMPLE, exec, SPIN, {}) as call:
        assert process.call(AMPLE, pow, 2, 2) == 4
        assert not call.has_ended(0.01)


def test_a_call_ends_with_its_block(busy):
    with busy(AMPLE, SPIN) as (_, pid):
        pass
    assert has_ended(pid)


@pytest.mark.parametrize(('allowance', 'code', 'message'), [
    (AMPLE._replace(memory_bytes=200_000_000), GROW, 'more than 200 MB of memory'),
    (AMPLE._replace(memory_bytes=500_000_000), 'bytearray(1_000_000_000)',
     'more than 500 MB of memory'),
    (SHORT, SPIN, 'more than 1 s of processor time'),
])
def test_a_call_that_exceeds_a_limit_is_ended(lasting, allowance, code, message):
    with pytest.raises(LimitExceededError) as caught:
        lasting.call(allowance, exec, code, {})
    assert str(caught.value) == message


def test_a_process_that_reads_much_may_take_longer(process, pipe, monkeypatch):
    reader, writer = pipe
    code = ('import os, time; from sdf_pose_bridge.process_limits import raise_limits\n'
            f'raise_limits(1_000_000, 2000.0, 1e10); os.write({writer}, b"."); time.sleep(1000)')
    allowance = SHORT._replace(seconds_per_megabyte=1000.0)
    with process.start(allowance, exec, code, {}) as call:
        assert select.select([reader], [], [], DEADLINE_S)[0], 'the call does not begin'
        assert not call.has_ended(0.0)
        # The time without the limit that was raised is over.
        monkeypatch.setattr(limited_process, 'WAITING_S', -100.0)
        assert not call.has_ended(0.0)


def test_other_threads_run_while_much_is_answered(process):
    offsets, has_answer = set(), threading.Event()
    with process.start(AMPLE, eval, '[str(each) for each in range(2_000_000)]', {}) as call:
        assert call.has_ended(DEADLINE_S)
        descriptor = call._file.fileno()

        def watch():
            while not has_answer.wait(0.0001):
                offsets.add(os.lseek(descriptor, 0, os.SEEK_CUR))

        thread = threading.Thread(target=watch)
        thread.start()
        call.result()
        has_answer.set()
        thread.join()
    # A thread that has to wait for the whole answer sees its begin and its end.
    assert len(offsets) > 3


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_signal_to_the_group_is_not_for_it(lasting, busy, number):
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, [])
    with busy(AMPLE, 'import signal; signal.sigwait([signal.SIGUSR1])') as (call, pid):
        os.kill(pid, number)
        os.kill(lasting._pid, number)
        os.kill(pid, signal.SIGUSR1)
        with pytest.raises(ProcessEndedError, match='by signal 10'):
            call.result()
    assert signal.pthread_sigmask(signal.SIG_BLOCK, []) == mask


# Processes that are killed or stopped


@pytest.mark.parametrize(('code', 'message'), [
    ('import signal; signal.raise_signal(signal.SIGUSR1)', 'has ended by signal 10'),
    ('import os; os._exit(3)', 'has ended with exit code 3'),
    ('import sys; sys.exit()', 'has ended with exit code 1'),
])
def test_a_process_that_ends_itself_would_do_so_again(process, code, message):
    with pytest.raises(ProcessEndedError, match=message) as caught:
        process.call(AMPLE, exec, code, {})
    assert not caught.value.is_temporary


@pytest.mark.parametrize(('function', 'message'), [
    ('os.abort()', 'has ended by signal 6'), ('os.kill(os.getpid(), 9)', 'has ended by signal 9'),
    ('1 / 0', 'has ended with exit code 1')])
def test_a_process_that_ends_before_it_begins_is_an_error(function, message):
    def fail():
        faulthandler.disable()
        eval(function)

    process = LimitedProcess(lambda: setattr(limited_process, 'end_with_parent', fail))
    with pytest.raises(ProcessEndedError, match=message):
        process.call(AMPLE, pow, 2, 2)
    process.close()


def test_a_process_that_is_stopped_while_it_is_busy_is_killed(lasting, busy, monkeypatch):
    monkeypatch.setattr(limited_process, 'WAITING_S', 0.0)
    # The time is over before the caller knows of the process.
    at_once = AMPLE._replace(processor_s=0.0)
    with (pytest.raises(ProcessEndedError, match=NO_ANSWER),
          busy(at_once, 'import signal; signal.raise_signal(signal.SIGSTOP)') as (call, pid)):
        call.result()
    assert has_ended(pid)


def test_a_process_that_is_stopped_in_the_middle_of_its_answer_is_killed(lasting, monkeypatch):
    monkeypatch.setattr(limited_process, 'WAITING_S', 0.0)
    with pytest.raises(ProcessEndedError, match=NO_ANSWER) as caught:
        lasting.call(SHORT, StopsWhenPickled)
    assert caught.value.is_temporary


def test_a_waiting_process_that_is_stopped_keeps_nobody_waiting_longer(lasting, monkeypatch):
    monkeypatch.setattr(limited_process, 'WAITING_S', 0.0)
    os.kill(lasting._pid, signal.SIGSTOP)
    for _ in range(2):
        with pytest.raises(ProcessEndedError, match=NO_ANSWER):
            lasting.call(SHORT, pow, 2, 2)
    os.kill(lasting._pid, signal.SIGCONT)


def test_a_call_is_answered_although_the_waiting_process_is_stopped(process, pipe):
    reader, writer = pipe
    code = f'import os, signal; os.kill(os.getppid(), signal.SIGSTOP); os.write({writer}, b".")'
    process.call(AMPLE, exec, code, {})
    assert os.read(reader, 1) == b'.'


def test_a_waiting_process_that_is_killed_ends_its_call(process, busy):
    with busy(AMPLE, SPIN) as (call, pid):
        os.kill(process._pid, signal.SIGKILL)
        with pytest.raises(ProcessEndedError, match=STARTER_ENDED):
            call.result()
    assert has_ended(pid)


def test_a_waiting_process_that_is_killed_is_an_error_that_stays(process):
    os.kill(process._pid, signal.SIGKILL)
    for _ in range(2):
        with pytest.raises(ProcessEndedError, match=STARTER_ENDED) as caught:
            process.call(AMPLE, pow, 2, 2)
        assert not caught.value.is_temporary


def test_without_descriptors_a_call_is_an_error_that_passes(lasting):
    limits = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (0, limits[1]))
    try:
        with pytest.raises(ProcessEndedError, match=r'cannot be started.*open files') as caught:
            lasting.call(AMPLE, pow, 2, 2)
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, limits)
    assert caught.value.is_temporary


def test_if_no_process_can_be_forked_a_call_is_an_error_that_passes():
    def fail():
        raise BlockingIOError(11, 'no more processes')

    with contextlib.closing(LimitedProcess(lambda: setattr(os, 'fork', fail))) as process:
        for _ in range(2):
            with pytest.raises(ProcessEndedError, match='cannot be started: no more') as caught:
                process.call(AMPLE, pow, 2, 2)
            assert caught.value.is_temporary


def test_a_closed_process_ends_its_call(process, busy):
    with busy(AMPLE, SPIN) as (call, pid):
        waiting = process._pid
        process.close()
        with pytest.raises(ProcessEndedError):
            call.result()
    assert has_ended(pid)
    assert has_ended(waiting)
    with pytest.raises(ProcessEndedError, match=STARTER_ENDED):
        process.call(AMPLE, pow, 2, 2)


PARENT = """
import sys, threading
from sdf_pose_bridge.limited_process import LimitedProcess
from sdf_pose_bridge.process_limits import FOR_FILES
process = LimitedProcess()
print(process._pid, flush=True)
if {code!r}:
    threading.Thread(
        target=process.call, args=(FOR_FILES, exec, {code!r}, {{}}), daemon=True).start()
sys.stdin.read()
"""


@pytest.mark.parametrize('code', [
    '', SPIN, 'sum(range(10**12))', 'import signal; signal.raise_signal(signal.SIGSTOP)'])
@pytest.mark.parametrize('number', [signal.SIGKILL, signal.SIGTERM])
def test_no_process_outlives_the_one_that_has_started_it(code, number):
    # The busy process writes its id where that of the waiting one comes from.
    reader, writer = os.pipe()
    if code:
        code = f'import os; os.write({writer}, b"%d" % os.getpid())\n{code}'
    parent = started(
        [sys.executable, '-c', PARENT.format(code=code)], stdin=subprocess.PIPE,
        stdout=subprocess.PIPE, text=True, pass_fds=[writer])
    pids = [int(parent.stdout.readline())]
    os.close(writer)
    if code:
        pids.append(int(os.read(reader, 20)))
    os.close(reader)
    parent.send_signal(number)
    parent.communicate()
    assert all(map(has_ended, pids))
