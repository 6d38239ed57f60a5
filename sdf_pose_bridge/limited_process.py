# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Call functions in processes with limits, which end with the call.

A process that waits is forked once, before this one starts threads. For each call it forks again.
So each call begins in a clean process in which everything is imported, and no call, however
hostile its input, leaves anything behind. Linux only.
"""

from __future__ import annotations

from collections.abc import Callable
import contextlib
import ctypes
import errno
import gc
import math
import os
import pickle
import resource
import select
import signal
import socket
import struct
import time
import traceback
from typing import BinaryIO, Generic, NoReturn, TypeVar

from sdf_pose_bridge.process_limits import Allowance, limited, LimitExceededError

WAITING_S = 50.0
"""Elapsed time in s of a call beyond its processor time, for disks and other processes."""

_PR_SET_PDEATHSIG = 1

_STATUS = struct.Struct('=cid')
"""A report about a call: one of the events below, its number, and processor time in s."""
_BEGUN = b'b'
"""The number is the id of the process."""
_ENDED = b'e'
"""The number is the exit code, or the signal below zero."""
_NOT_STARTED = b'n'
"""The number is the error number."""

_NO_MEMORY = 'there is not enough memory to read the file'

_Result = TypeVar('_Result')


class ProcessEndedError(Exception):
    """The process did not answer, or could not be started, or there is no memory."""

    def __init__(self, message: str, *, is_temporary: bool) -> None:
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

    def start(
        self, allowance: Allowance, function: Callable[..., _Result], *arguments: object,
    ) -> Call[_Result]:
        """
        Call a function in a process of its own; ``with`` ends it at the end of the block.

        :param allowance: the limits of the process.
        :param function: a function of a module; its arguments and result can be pickled.
        :raises ProcessEndedError: if the process cannot be started.
        """
        with contextlib.ExitStack() as stack:
            try:
                # Call and answer are in memory, so no process waits for another one to read.
                file = stack.enter_context(open(os.memfd_create('call'), 'r+b'))  # noqa: PTH123
                status, other_end = map(stack.enter_context, socket.socketpair())
                pickle.dump((allowance, function, arguments), file, 5)
                file.flush()
                if self._pid:
                    socket.send_fds(self._calls, [b'.'], [file.fileno(), other_end.fileno()])
            except BrokenPipeError:
                pass  # the waiting process has ended, as its missing status shows
            except OSError as error:
                msg = f'the process that reads files cannot be started: {error}'
                raise ProcessEndedError(msg, is_temporary=True) from error
            except MemoryError:
                raise ProcessEndedError(_NO_MEMORY, is_temporary=True) from None
            other_end.close()
            return Call(self, allowance, file, status, stack.pop_all())

    def close(self) -> None:
        """End the processes; calls that are running, and further ones, fail."""
        pid, self._pid = self._pid, 0
        if pid:
            os.kill(pid, signal.SIGKILL)
            os.waitpid(pid, 0)
            self._calls.close()


class Call(Generic[_Result]):
    """
    A call of a function in a process of its own, which has been started.

    :param file: gets the answer.
    :param status: gets reports about the process.
    :param opened: closes both.
    """

    def __init__(
        self, process: LimitedProcess, allowance: Allowance, file: BinaryIO,
        status: socket.socket, opened: contextlib.ExitStack,
    ) -> None:
        self._process = process
        self._allowance = allowance
        self._file = file
        self._status = status
        self._opened = opened
        self._begin = time.monotonic()
        self._pid = 0
        self._end: tuple[bytes, int, float] | None = None

    def __enter__(self) -> Call[_Result]:
        return self

    def __exit__(self, *_exception: object) -> None:
        with contextlib.suppress(ProcessEndedError):
            self.has_ended(0.0)  # the process may have begun since then
        if self._pid and self._end is None:
            with contextlib.suppress(ProcessLookupError):
                os.kill(self._pid, signal.SIGKILL)
        self._opened.close()

    def has_ended(self, timeout_s: float) -> bool:
        """
        Wait until the process has answered or ended.

        :param timeout_s: the longest time in s.
        :return: whether it has; then :meth:`result` need not wait.
        :raises ProcessEndedError: if it takes ``WAITING_S`` longer than the allowed processor
            time, or if the waiting process has ended.
        """
        ends_at = time.monotonic() + timeout_s
        while self._end is None:
            longest_s = self._allowance.processor_s + WAITING_S
            with contextlib.suppress(OSError):  # the process has ended
                if self._pid:
                    # It has raised its own limit if it has read much.
                    soft, _ = resource.prlimit(self._pid, resource.RLIMIT_CPU)
                    longest_s = max(longest_s, soft + WAITING_S)
            last = self._begin + longest_s
            self._status.settimeout(max(min(ends_at, last) - time.monotonic(), 1e-6))
            try:
                message = self._status.recv(_STATUS.size)
            except TimeoutError:
                now = time.monotonic()
                if now >= last:
                    # The kernel would have ended it if it had used all of its processor time.
                    msg = (f'the process that reads files has not answered in {longest_s:.0f} s, '
                           f'of which it used {_processor_s(self._pid):.1f} s of the processor: '
                           'it was stopped, or waits for a disk or for other processes')
                    raise ProcessEndedError(msg, is_temporary=True) from None
                if now >= ends_at:
                    return False
                continue
            if not message:
                self._process.close()
                msg = ('the process that starts the reading of files has ended; start this '
                       'program again')
                raise ProcessEndedError(msg, is_temporary=False)
            report = _STATUS.unpack(message)
            if report[0] == _BEGUN:
                self._pid = report[1]
            else:
                self._end = report
        return True

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
        assert self._end is not None
        event, number, processor_s = self._end
        if event == _NOT_STARTED:
            msg = f'the process that reads files cannot be started: {os.strerror(number)}'
            raise ProcessEndedError(msg, is_temporary=True)
        if number == -signal.SIGXCPU:
            msg = f'more than {processor_s:.0f} s of processor time'
            raise LimitExceededError(msg)
        if number:
            how = f'by signal {-number}' if number < 0 else f'with exit code {number}'
            # The kernel uses this signal when memory runs out.
            msg = f'the process that reads files has ended {how}'
            raise ProcessEndedError(msg, is_temporary=number == -signal.SIGKILL)
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
        _end_with_parent()
        prepare()
        # To search for garbage would copy the memory that the processes share.
        gc.freeze()
        _, most_bytes = resource.getrlimit(resource.RLIMIT_CORE)
        resource.setrlimit(resource.RLIMIT_CORE, (0, most_bytes))
        nowhere = os.open(os.devnull, os.O_WRONLY)
        for descriptor in (1, 2):
            os.dup2(nowhere, descriptor)
        poll = select.poll()
        poll.register(calls, select.POLLIN)
        # The process and the caller of each call, by a descriptor of the process.
        running: dict[int, tuple[int, socket.socket]] = {}
        while True:
            for descriptor, _ in poll.poll():
                if descriptor in running:
                    poll.unregister(descriptor)
                    os.close(descriptor)
                    pid, status = running.pop(descriptor)
                    _, code, usage = os.wait4(pid, 0)
                    _report(status, _ENDED, os.waitstatus_to_exitcode(code),
                            usage.ru_utime + usage.ru_stime)
                    continue
                _, descriptors, _, _ = socket.recv_fds(calls, 1, 2)
                if not descriptors:
                    os._exit(1)
                status = socket.socket(fileno=descriptors[1])
                with open(descriptors[0], 'r+b') as file:  # noqa: PTH123
                    pid = _process_of_call(file, status)
                if pid:
                    descriptor = os.pidfd_open(pid)
                    running[descriptor] = pid, status
                    poll.register(descriptor, select.POLLIN)
    finally:
        os._exit(1)


def _process_of_call(file: BinaryIO, status: socket.socket) -> int:
    """Fork for a call, and return the id of the process; 0 after a report that there is none."""
    try:
        pid = os.fork()
    except OSError as error:
        _report(status, _NOT_STARTED, error.errno or errno.EAGAIN)
        return 0
    if pid == 0:
        _answer_call(file, status)
    return pid


def _report(
    status: socket.socket, event: bytes, number: int, processor_s: float = 0.0,
) -> None:
    """Send the last report about a call."""
    with status, contextlib.suppress(BrokenPipeError):  # the caller waits no longer
        status.sendall(_STATUS.pack(event, number, processor_s))


def _answer_call(file: BinaryIO, status: socket.socket) -> NoReturn:
    """Read a call from a file, write the answer into it, report this, and end the process."""
    code = 1
    try:
        _end_with_parent()
        status.sendall(_STATUS.pack(_BEGUN, os.getpid(), 0.0))
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
        code = 0
        status.sendall(_STATUS.pack(_ENDED, code, 0.0))
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


def _processor_s(pid: int) -> float:
    """Return the processor time that a process has used in s; 0 if there is none."""
    clock = ~pid << 3 | 2  # as clock_getcpuclockid of the C library
    try:
        return time.clock_gettime(clock) if pid else 0.0
    except OSError:
        return 0.0


def _end_with_parent() -> None:
    """Have the kernel end this process with its parent, also while it is busy or stopped."""
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
