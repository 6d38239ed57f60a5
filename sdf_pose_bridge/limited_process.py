# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Call functions in a separate process with limits, which can be ended at any time.

A hostile file cannot exhaust the memory of the calling process. Limits of memory and processor
time work on Linux only.
"""

from __future__ import annotations

from collections.abc import Callable
import contextlib
import fcntl
import os
import pickle
import resource
import select
import signal
import sys
import threading
import time
import traceback
from typing import Any, BinaryIO, NamedTuple, TypeVar

KEPT_S = 60.0
"""Time in s for which a process is kept for further calls."""

MOST_KEPT_BYTES = 256_000_000
"""The most memory that a process keeps between two calls."""

_PERIOD_S = 0.05
"""Period in s at which the use of a process is compared with its limits."""

_CODE = (
    'import sys; sys.path[:] = sys.argv[2:]; '
    'from sdf_pose_bridge.limited_process import serve; serve(int(sys.argv[1]))')

_TICK_S = 1.0 / os.sysconf('SC_CLK_TCK')
_PAGE_BYTES = os.sysconf('SC_PAGE_SIZE')
_MEGABYTE = 1_000_000

_IS_READ = b'.'
"""Written before the answer when a call is read."""

_NO_MEMORY = pickle.dumps((None, MemoryError(), ''), 5)

_Result = TypeVar('_Result')


class LimitExceededError(Exception):
    """A call exceeds its limits; the text begins with "more than"."""


class ProcessEndedError(Exception):
    """The process ended before it answered, or could not be started."""

    def __init__(self, message: str, *, may_pass: bool) -> None:
        super().__init__(message)
        self.may_pass = may_pass
        """Whether the same call may succeed later, because it did not end the process itself."""


class _CallNotReadError(ProcessEndedError):
    """The process ended before it had read the call."""


class Allowance(NamedTuple):
    """The limits of a call; they grow with each megabyte that it reads."""

    memory_bytes: int
    processor_s: float
    wall_s: float
    """Elapsed time, including waiting for a disk."""
    memory_bytes_per_megabyte: int = 0
    seconds_per_megabyte: float = 0.0
    """Added to both times."""
    address_space_bytes: int = 0
    """Limit of the address space, so that one huge array fails at once; 0 for no limit."""


class _Use(NamedTuple):
    """Resources that a process has used so far."""

    memory_bytes: int
    """Current memory."""
    processor_s: float
    bytes_read: int


class LimitedProcess:
    """
    Calls functions in another process, one after the other.

    The process is started for the first call. It ends when it was not used for a while, when a
    call exceeds its limits, and together with this process. All methods are thread-safe.

    :param allowance: the limits of each call.
    """

    def __init__(self, allowance: Allowance) -> None:
        self._allowance = allowance
        self._lock = threading.Lock()
        self._child: _Child | None = None
        self._timer: threading.Timer | None = None

    def call(self, function: Callable[..., _Result], *arguments: object) -> _Result:
        """
        Call a function in the process.

        :param function: a function of a module; its arguments and result can be pickled.
        :return: its result.
        :raises LimitExceededError: if it exceeds its limits.
        :raises ProcessEndedError: if the process ends during the call, or cannot be started.
        :raises MemoryError: if the system has no memory for it.
        :raises Exception: any exception of the function.
        """
        with self._lock:
            if self._timer is not None:
                self._timer.cancel()
            try:
                if self._child is None:
                    self._child = _Child()
                call = self._allowance, function, arguments
                try:
                    result, error = self._child.result_and_error(*call)
                except _CallNotReadError:  # it was killed before
                    self._end()
                    self._child = _Child()
                    result, error = self._child.result_and_error(*call)
            except BaseException:
                self._end()
                raise
            if self._child.use().memory_bytes > MOST_KEPT_BYTES:
                self._end()
            else:
                self._end_later()
        if error is not None:
            raise error
        return result  # type: ignore[no-any-return]

    def close(self) -> None:
        """End the process; a further call starts another one."""
        with self._lock:
            self._end()

    def _end(self) -> None:
        if self._child is not None:
            self._child.end()
            self._child = None

    def _end_later(self) -> None:
        def end_if_unused() -> None:
            with self._lock:
                if self._timer is timer:
                    self._end()

        timer = self._timer = threading.Timer(KEPT_S, end_if_unused)
        timer.daemon = True
        try:
            timer.start()
        except RuntimeError:  # no memory for another thread
            self._end()


class _Child:
    """
    The process, which reads calls from its standard input and writes answers to its output.

    :raises ProcessEndedError: if it cannot be started.
    """

    def __init__(self) -> None:
        # Imported here because it takes 5 ms, and many programs call nothing.
        import subprocess
        ends: tuple[int, ...] = ()
        # Ctrl-C is for this process; the other one has it blocked from its start.
        mask = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
        try:
            # Nothing is written to this pipe. When its last end here is closed, the process ends.
            ends = life, self._life = os.pipe()
            self._process = subprocess.Popen(
                [sys.executable, '-c', _CODE, str(life), *sys.path], stdin=subprocess.PIPE,
                stdout=subprocess.PIPE, pass_fds=[life],
                # Threads of numpy for large matrices would take memory.
                env={**os.environ, 'OPENBLAS_NUM_THREADS': '1'})
        except (OSError, MemoryError) as error:
            for end in ends:
                os.close(end)
            msg = f'the process that reads files cannot be started: {error}'
            raise ProcessEndedError(msg, may_pass=True) from error
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        os.close(life)
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._calls, self._answers = self._process.stdin, self._process.stdout

    def result_and_error(
        self, allowance: Allowance, function: Callable[..., Any], arguments: tuple[object, ...],
    ) -> tuple[Any, Exception | None]:
        """Return the result of a function and the exception that it raised instead."""
        before, begin = self.use(), time.monotonic()
        answers = select.poll()
        answers.register(self._answers, select.POLLIN)

        def wait() -> None:
            while not answers.poll(1e3 * _PERIOD_S):
                _check(self.use(), before, time.monotonic() - begin, allowance)

        is_read = False
        try:
            pickle.dump((allowance.address_space_bytes, function, arguments), self._calls, 5)
            self._calls.flush()
            wait()
            is_read = os.read(self._answers.fileno(), len(_IS_READ)) == _IS_READ
            wait()
            # Other threads can run after each piece.
            result, error, text = pickle.load(self._answers)
        except (EOFError, OSError, pickle.UnpicklingError) as ended:
            raise self._reason_of_end(
                ProcessEndedError if is_read else _CallNotReadError) from ended
        if isinstance(error, MemoryError):
            if allowance.address_space_bytes:
                raise LimitExceededError(
                    _more_than_bytes(allowance.address_space_bytes)) from error
            raise error
        if error is not None:
            error.__cause__ = RuntimeError(f'in another process:\n{text}')
        return result, error

    def use(self) -> _Use:
        """Return its use of resources; zeros if it has ended or this is unknown."""
        folder = f'/proc/{self._process.pid}'
        try:
            with open(f'{folder}/statm') as file:  # noqa: PTH123 - a quarter of the time of Path
                pages = int(file.read().split()[1])
            with open(f'{folder}/stat') as file:  # noqa: PTH123
                # The name of the program, in brackets, may contain any character.
                fields = file.read().rpartition(')')[2].split()
            with open(f'{folder}/io') as file:  # noqa: PTH123
                bytes_read = int(file.readline().split()[1])
        except (OSError, IndexError):
            return _Use(0, 0.0, 0)
        return _Use(
            pages * _PAGE_BYTES, (int(fields[11]) + int(fields[12])) * _TICK_S, bytes_read)

    def end(self) -> None:
        self._process.kill()
        os.close(self._life)
        for pipe in (self._calls, self._answers):
            with contextlib.suppress(OSError):
                pipe.close()
        self._wait_for_end()

    def _wait_for_end(self) -> None:
        import subprocess
        # A process that waits for a disk cannot be ended before the disk answers.
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(1.0)

    def _reason_of_end(self, kind: type[ProcessEndedError]) -> ProcessEndedError:
        self._wait_for_end()
        code = self._process.returncode
        how = f'by signal {-code}' if code is not None and code < 0 else f'with exit code {code}'
        # The kernel uses this signal when memory runs out.
        return kind(
            f'the process that reads files has ended {how}', may_pass=code == -signal.SIGKILL)


def _check(use: _Use, before: _Use, seconds: float, allowance: Allowance) -> None:
    """:raises LimitExceededError: if a call has exceeded its limits."""
    megabytes = (use.bytes_read - before.bytes_read) / _MEGABYTE
    most_bytes = allowance.memory_bytes + megabytes * allowance.memory_bytes_per_megabyte
    if use.memory_bytes > most_bytes:
        raise LimitExceededError(_more_than_bytes(most_bytes))
    more_s = megabytes * allowance.seconds_per_megabyte
    if use.processor_s - before.processor_s > allowance.processor_s + more_s:
        msg = f'more than {allowance.processor_s + more_s:.3g} s of processor time'
        raise LimitExceededError(msg)
    if seconds > allowance.wall_s + more_s:
        msg = f'more than {allowance.wall_s + more_s:.3g} s'
        raise LimitExceededError(msg)


def _more_than_bytes(count: float) -> str:
    return f'more than {count / _MEGABYTE:.0f} MB of memory'


def serve(life: int) -> None:
    """
    Answer the calls that come on standard input, until it ends.

    :param life: a pipe that nobody writes to; when its other end is closed, this process ends.
    """
    _end_with(life)
    calls: BinaryIO = os.fdopen(os.dup(0), 'rb')
    answers: BinaryIO = os.fdopen(os.dup(1), 'wb')
    # Output of libraries must not come between the answers.
    nowhere = os.open(os.devnull, os.O_RDWR)
    for descriptor in (0, 1, 2):
        os.dup2(nowhere, descriptor)
    with contextlib.suppress(OSError), open('/proc/self/oom_score_adj', 'w') as file:  # noqa: PTH123
        # When memory runs out, this process is ended, not the one that serves others.
        file.write('1000')
    while True:
        try:
            address_space_bytes, function, arguments = pickle.load(calls)
        except EOFError:
            return
        answers.write(_IS_READ)
        answers.flush()
        if address_space_bytes:
            _, highest = resource.getrlimit(resource.RLIMIT_AS)
            with contextlib.suppress(ValueError):  # the user's own limit is lower
                resource.setrlimit(resource.RLIMIT_AS, (address_space_bytes, highest))
        answers.write(_answer(function, arguments))
        answers.flush()


def _answer(function: Callable[..., object], arguments: tuple[object, ...]) -> bytes:
    """Return the result of a function, the exception that it raised instead, and its traceback."""
    try:
        try:
            return pickle.dumps((function(*arguments), None, ''), 5)
        except MemoryError:
            raise
        except Exception as error:  # noqa: BLE001 - raised by the one who called
            text = traceback.format_exc()
            try:
                return pickle.dumps((None, error, text), 5)
            except Exception:  # noqa: BLE001 - errors of libraries may hold anything
                return pickle.dumps((None, RuntimeError(repr(error)), text), 5)
    except MemoryError:
        return _NO_MEMORY


def _end_with(life: int) -> None:
    """Have the kernel end this process with the process at the other end of a pipe."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGIO, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_SETMASK, [])
    fcntl.fcntl(life, fcntl.F_SETOWN, os.getpid())
    fcntl.fcntl(life, fcntl.F_SETFL, fcntl.fcntl(life, fcntl.F_GETFL) | os.O_ASYNC)
    if select.select([life], [], [], 0.0)[0]:  # it has ended before
        sys.exit()
