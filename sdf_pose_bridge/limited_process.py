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
import os
import pickle
import resource
import signal
import socket
import struct
import threading
import time
import traceback
from typing import BinaryIO, NoReturn, TypeVar

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

_Result = TypeVar('_Result')


class ProcessEndedError(Exception):
    """The process ended before it answered, or could not be started."""

    def __init__(self, message: str, *, may_pass: bool) -> None:
        super().__init__(message)
        self.may_pass = may_pass
        """Whether the same call may succeed later, because it did not end the process itself."""


class LimitedProcess:
    """
    Calls functions in other processes, one after the other.

    It must be made by the main thread while there is no other thread. All methods are thread-safe.
    The other processes end with this one, also when it is killed.

    :param prepare: is called once in the waiting process, to import what calls need.
    """

    def __init__(self, prepare: Callable[[], None] = lambda: None) -> None:
        self._lock = threading.Lock()
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
        meanwhile: Callable[[], None] | None = None,
    ) -> _Result:
        """
        Call a function in a process of its own.

        :param allowance: the limits of the process.
        :param function: a function of a module; its arguments and result can be pickled.
        :param meanwhile: a function to call here while the other one runs.
        :return: its result.
        :raises LimitExceededError: if it exceeds a limit, or takes ``WAITING_S`` longer than the
            allowed processor time.
        :raises ProcessEndedError: if the process ends during the call, or cannot be started.
        :raises MemoryError: if this process has no memory for the call or for its answer.
        :raises Exception: any exception of the function.
        """
        with self._lock, contextlib.ExitStack() as stack:
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
                raise ProcessEndedError(msg, may_pass=True) from error
            other_end.close()
            if meanwhile is not None:
                meanwhile()
            self._wait_for_end(status, allowance)
            file.seek(0)
            # Other threads can run after each piece.
            result, exception, text = pickle.load(file)
        if exception is not None:
            raise exception from RuntimeError(f'in another process:\n{text}')
        return result  # type: ignore[no-any-return]

    def close(self) -> None:
        """End the processes; a call that is running, and further ones, fail."""
        pid, self._pid = self._pid, 0
        if pid:
            os.kill(pid, signal.SIGKILL)
            os.waitpid(pid, 0)
            self._calls.close()

    def _wait_for_end(self, status: socket.socket, allowance: Allowance) -> None:
        """
        Wait until the process of a call has answered and ended.

        :raises LimitExceededError: as :meth:`call`.
        :raises ProcessEndedError: as :meth:`call`.
        """
        begin, pid, event = time.monotonic(), 0, _BEGUN
        try:
            while event == _BEGUN:
                longest_s = allowance.processor_s + WAITING_S
                with contextlib.suppress(OSError):  # the process has ended
                    if pid:
                        # It has raised its own limit if it has read much.
                        soft, _ = resource.prlimit(pid, resource.RLIMIT_CPU)
                        longest_s = max(longest_s, soft + WAITING_S)
                left_s = begin + longest_s - time.monotonic()
                if left_s <= 0.0:
                    msg = f'more than {longest_s:.0f} s'
                    raise LimitExceededError(msg)
                status.settimeout(left_s)
                with contextlib.suppress(TimeoutError):
                    message = status.recv(_STATUS.size)
                    if not message:
                        self.close()
                        msg = ('the process that starts the reading of files has ended; start '
                               'this program again')
                        raise ProcessEndedError(msg, may_pass=False)
                    event, number, processor_s = _STATUS.unpack(message)
                    if event == _BEGUN:
                        pid = number
        except BaseException:
            if pid:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
            raise
        if event == _NOT_STARTED:
            msg = f'the process that reads files cannot be started: {os.strerror(number)}'
            raise ProcessEndedError(msg, may_pass=True)
        if number == -signal.SIGXCPU:
            msg = f'more than {processor_s:.0f} s of processor time'
            raise LimitExceededError(msg)
        if number:
            how = f'by signal {-number}' if number < 0 else f'with exit code {number}'
            # The kernel uses this signal when memory runs out.
            msg = f'the process that reads files has ended {how}'
            raise ProcessEndedError(msg, may_pass=number == -signal.SIGKILL)


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
        while (received := socket.recv_fds(calls, 1, 2))[0]:
            with (
                open(received[1][0], 'r+b') as file,  # noqa: PTH123
                socket.socket(fileno=received[1][1]) as status,
                contextlib.suppress(BrokenPipeError),  # the caller waits no longer
            ):
                try:
                    pid = os.fork()
                except OSError as error:
                    status.sendall(_STATUS.pack(_NOT_STARTED, error.errno or errno.EAGAIN, 0.0))
                    continue
                if pid == 0:
                    _answer_call(file, status)
                _, code, usage = os.wait4(pid, 0)
                status.sendall(_STATUS.pack(
                    _ENDED, os.waitstatus_to_exitcode(code), usage.ru_utime + usage.ru_stime))
    finally:
        os._exit(1)


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


def _end_with_parent() -> None:
    """Have the kernel end this process with its parent, also while it is busy or stopped."""
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
