# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Call functions in processes with limits, which end with the call.

A process that waits is forked once, before this one starts threads. For each call it forks again.
So each call begins in a clean process in which everything is imported, and no call, however
hostile its input, leaves anything behind. Linux only.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
import contextlib
import ctypes
import gc
import math
import os
import pickle
import resource
import selectors
import signal
import socket
import time
import traceback
from typing import BinaryIO, Generic, NoReturn, TypeVar

from sdf_pose_bridge.process_limits import Allowance, limited, LimitExceededError, open_streams

WAITING_S = 50.0
"""Elapsed time in s of a call beyond its processor time, for disks and other processes."""

_CHECK_PERIOD_S = 0.5
_LONGEST_REPORT = 10_000
_PR_SET_PDEATHSIG = 1

_NO_MEMORY = 'there is not enough memory to read the file'

_Result = TypeVar('_Result')


class ProcessEndedError(Exception):
    """The process did not answer, or could not be started, or there is no memory."""

    def __init__(self, message: str, *, is_temporary: bool = False) -> None:
        super().__init__(message)
        self.is_temporary = is_temporary
        """Whether the same call may succeed later, because it did not end the process itself."""


class LimitedProcess:
    """
    Calls functions in other processes.

    It must be made by the main thread while there is no other thread. All methods are thread-safe.
    The other processes end with this one, also when it is killed.

    :param prepare: is called once in the waiting process, to import what calls need.
    """

    def __init__(self, prepare: Callable[[], None] = lambda: None) -> None:
        open_streams()
        self._calls, calls = socket.socketpair()
        self._calls.setblocking(False)
        # These signals are for this process, which ends the other ones.
        mask = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT, signal.SIGTERM])
        try:
            self._pid = os.fork()
            if self._pid == 0:
                self._calls.close()
                _serve(calls, prepare)
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)
            calls.close()

    def call(
        self, allowance: Allowance, function: Callable[..., _Result], *arguments: object,
    ) -> _Result:
        """
        Call a function in a process of its own, and wait for its result.

        :return: as :meth:`Call.result`.
        :raises Exception: as :meth:`start` and :meth:`Call.result`.
        """
        with self.start(allowance, function, *arguments) as call:
            return call.result()

    @contextlib.contextmanager
    def start(
        self, allowance: Allowance, function: Callable[..., _Result], *arguments: object,
    ) -> Iterator[Call[_Result]]:
        """
        Call a function in a process of its own, which ends with the block.

        :param allowance: the limits of the process.
        :param function: a function of a module; its arguments and result can be pickled.
        :raises ProcessEndedError: if the process cannot be started.
        """
        with contextlib.ExitStack() as stack:
            try:
                # Call and answer are in memory, so no process waits for another one to read.
                file = stack.enter_context(open(os.memfd_create('call'), 'r+b'))  # noqa: PTH123
                status, other_end = map(
                    stack.enter_context, socket.socketpair(type=socket.SOCK_SEQPACKET))
                pickle.dump((allowance, function, arguments), file, 5)
                file.flush()
                if self._pid:
                    socket.send_fds(self._calls, [b'.'], [file.fileno(), other_end.fileno()])
            except BrokenPipeError:
                pass  # the waiting process has ended, as its missing status shows
            except OSError as error:
                raise _not_started(error) from error
            except MemoryError:
                raise ProcessEndedError(_NO_MEMORY, is_temporary=True) from None
            other_end.close()
            call = Call[_Result](allowance, file, status)
            stack.callback(call.end)
            yield call

    def close(self) -> None:
        """End the processes; calls that are running, and further ones, fail."""
        pid, self._pid = self._pid, 0
        if pid:
            os.kill(pid, signal.SIGKILL)
            with contextlib.suppress(ChildProcessError):  # if SIGCHLD is ignored
                os.waitpid(pid, 0)
            self._calls.close()


class Call(Generic[_Result]):
    """
    A call of a function in a process of its own, which has been started.

    :param file: gets the answer.
    :param status: gets the id of the process; at its end None, with the error that has ended it.
    """

    def __init__(self, allowance: Allowance, file: BinaryIO, status: socket.socket) -> None:
        self._allowance = allowance
        self._file = file
        self._status = status
        self._begin = time.monotonic()
        self._pid: int | None = 0
        """The id of the process; 0 before it is known, and None after its end."""
        self._error: Exception | None = None
        """The error that has ended it."""

    def end(self) -> None:
        """End the process, if it is still running."""
        with contextlib.suppress(ProcessEndedError):
            self.has_ended(0.0)  # the process may have begun since then
        if self._pid:
            with contextlib.suppress(ProcessLookupError):
                os.kill(self._pid, signal.SIGKILL)

    def has_ended(self, timeout_s: float) -> bool:
        """
        Wait until the process has answered or ended.

        :param timeout_s: the longest time in s.
        :return: whether it has; then :meth:`result` need not wait.
        :raises ProcessEndedError: if it takes ``WAITING_S`` longer than the allowed processor
            time, or if the waiting process has ended.
        """
        ends_at = time.monotonic() + timeout_s
        while self._pid is not None:
            left_s = ends_at - time.monotonic()
            self._status.settimeout(max(min(left_s, _CHECK_PERIOD_S), 1e-6))
            try:
                report = self._status.recv(_LONGEST_REPORT)
            except TimeoutError:
                self._check_time()
                if left_s <= _CHECK_PERIOD_S:
                    return False
                continue
            if not report:
                msg = ('the process that starts the reading of files has ended; start this '
                       'program again')
                raise ProcessEndedError(msg)
            self._pid, self._error = pickle.loads(report)
        return True

    def _check_time(self) -> None:
        """Raise an error if the process should have answered or ended before."""
        longest_s, used_s = self._allowance.processor_s + WAITING_S, 0.0
        with contextlib.suppress(OSError):  # the process has ended
            if self._pid:
                # It has raised its own limit if it has read much.
                soft, _ = resource.prlimit(self._pid, resource.RLIMIT_CPU)
                longest_s = max(longest_s, soft + WAITING_S)
                # The clock of a process, as clock_getcpuclockid of the C library.
                used_s = time.clock_gettime(~self._pid << 3 | 2)
        if time.monotonic() >= self._begin + longest_s:
            # The kernel would have ended it if it had used all of its processor time.
            msg = (f'the process that reads files has not answered in {longest_s:.0f} s, '
                   f'of which it used {used_s:.1f} s of the processor: '
                   'it was stopped, or waits for a disk or for other processes')
            raise ProcessEndedError(msg, is_temporary=True)

    def result(self) -> _Result:
        """
        Wait for the end of the process.

        :return: the result of the function.
        :raises LimitExceededError: if it exceeds a limit.
        :raises ProcessEndedError: if the process ends during the call, or cannot be started, if
            there is no memory for its answer, or as :meth:`has_ended`.
        :raises Exception: any exception of the function.
        """
        self.has_ended(math.inf)
        if self._error is not None:
            raise self._error
        self._file.seek(0)
        try:
            # Other threads can run after each piece.
            result, exception, text = pickle.load(self._file)
            if isinstance(exception, MemoryError):
                raise exception
        except MemoryError:
            raise ProcessEndedError(_NO_MEMORY, is_temporary=True) from None
        if exception is not None:
            raise exception from RuntimeError(f'in another process:\n{text}')
        return result  # type: ignore[no-any-return]


def _serve(calls: socket.socket, prepare: Callable[[], None]) -> NoReturn:
    """Fork for each call that comes, and report its end, until no more can come."""
    try:
        end_with_parent()
        # Others may have been ignored or blocked when this program was started.
        for number in (signal.SIGCHLD, signal.SIGXCPU):
            signal.signal(number, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_SETMASK, [signal.SIGINT, signal.SIGTERM])
        prepare()
        # To search for garbage would copy the memory that the processes share.
        gc.freeze()
        _, most_bytes = resource.getrlimit(resource.RLIMIT_CORE)
        resource.setrlimit(resource.RLIMIT_CORE, (0, most_bytes))
        nowhere = os.open(os.devnull, os.O_WRONLY)
        for descriptor in (1, 2):
            os.dup2(nowhere, descriptor)
        selector = selectors.DefaultSelector()
        selector.register(calls, selectors.EVENT_READ)
        while True:
            for key, _ in selector.select():
                if key.fileobj is calls:
                    _begin_call(calls, selector)
                    continue
                selector.unregister(key.fileobj)
                os.close(key.fd)
                pid, status = key.data
                _, code, usage = os.wait4(pid, 0)
                _report_end(status, _error_from_end(
                    os.waitstatus_to_exitcode(code), usage.ru_utime + usage.ru_stime))
    finally:
        os._exit(1)


def _begin_call(calls: socket.socket, selector: selectors.BaseSelector) -> None:
    """Fork for the next call, and watch the process."""
    # Nothing can be unpacked if the other process has ended, and then this one ends, too.
    _, (call, caller), _, _ = socket.recv_fds(calls, 1, 2)
    status = socket.socket(fileno=caller)
    with open(call, 'r+b') as file:  # noqa: PTH123
        try:
            pid = os.fork()
        except OSError as error:
            _report_end(status, _not_started(error.strerror))
            return
        if pid == 0:
            _answer_call(file, status)
    selector.register(os.pidfd_open(pid), selectors.EVENT_READ, (pid, status))


def _report_end(status: socket.socket, error: Exception | None) -> None:
    """Report that a process has ended, and the error that is the reason."""
    with status, contextlib.suppress(BrokenPipeError):  # the caller waits no longer
        status.send(pickle.dumps((None, error)))


def _not_started(reason: object) -> ProcessEndedError:
    msg = f'the process that reads files cannot be started: {reason}'
    return ProcessEndedError(msg, is_temporary=True)


def _error_from_end(code: int, processor_s: float) -> Exception | None:
    """Return the error for an exit code, or for a signal below zero; None for an answer."""
    if code == 0:
        return None
    if code == -signal.SIGXCPU:
        msg = f'more than {processor_s:.0f} s of processor time'
        return LimitExceededError(msg)
    how = f'by signal {-code}' if code < 0 else f'with exit code {code}'
    # The kernel uses this signal when memory runs out.
    msg = f'the process that reads files has ended {how}'
    return ProcessEndedError(msg, is_temporary=code == -signal.SIGKILL)


def _answer_call(file: BinaryIO, status: socket.socket) -> NoReturn:
    """Read a call from a file, write the answer into it, report this, and end the process."""
    code = 1
    try:
        end_with_parent()
        # This fails if the caller, which does not know this process, waits no longer.
        status.send(pickle.dumps((os.getpid(), None)))
        with contextlib.suppress(OSError), open('/proc/self/oom_score_adj', 'w') as score:  # noqa: PTH123
            # When memory runs out, this process is ended, not the one that serves others.
            score.write('1000')
        file.seek(0)
        answer = _answer(*pickle.load(file))
        file.seek(0)
        file.truncate()
        file.write(answer)
        file.flush()
        # The end of the process takes a while, and the caller need not wait for it.
        status.send(pickle.dumps((None, None)))
        code = 0
    finally:
        os._exit(code)


def _answer(
    allowance: Allowance, function: Callable[..., object], arguments: tuple[object, ...],
) -> bytes:
    """Return the result of a function, the exception that it raised instead, and its traceback."""
    try:
        with limited(allowance):
            return pickle.dumps((function(*arguments), None, ''), 5)
    except Exception as error:  # noqa: BLE001 - raised by the one who called
        text = traceback.format_exc()
        try:
            return pickle.dumps((None, error, text), 5)
        except Exception:  # noqa: BLE001 - errors of libraries may hold anything
            return pickle.dumps((None, RuntimeError(repr(error)), text), 5)


def end_with_parent() -> None:
    """Have the kernel end this process with its parent, also while it is busy or stopped."""
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
