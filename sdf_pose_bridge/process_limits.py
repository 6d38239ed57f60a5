# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Limit the processor time and the memory of this process, in proportion to what it reads.

The kernel enforces these limits, so they hold for all code, also that of libraries. They work on
Linux only.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
import math
import os
import resource
import sys
import time
from typing import NamedTuple

_MEGABYTE = 1_000_000


class LimitExceededError(Exception):
    """A limit is exceeded; the text begins with "more than"."""


class Allowance(NamedTuple):
    """Processor time and memory that a process may use beyond what it has used before."""

    processor_s: float
    """The kernel rounds it up to a whole second."""
    memory_bytes: int
    """Address space."""
    seconds_per_megabyte: float = 0.0
    """More processor time for each megabyte of :func:`raise_limits`."""
    memory_bytes_per_megabyte: int = 0


FOR_FILES = Allowance(
    processor_s=9.0, memory_bytes=700_000_000,
    seconds_per_megabyte=10.0, memory_bytes_per_megabyte=200_000_000)
"""For reading SDFormat: several times the use of the largest files on slow machines."""


class _Limits:
    """The limits of this process, which grow."""

    def __init__(self, allowance: Allowance) -> None:
        with open('/proc/self/statm', encoding='ascii') as file:  # noqa: PTH123 - fewer imports
            memory_bytes = int(file.read().split()[0]) * resource.getpagesize()
        self._allowance = allowance
        self._used = {
            resource.RLIMIT_CPU: time.process_time(), resource.RLIMIT_AS: float(memory_bytes)}
        self._before = {kind: resource.getrlimit(kind) for kind in self._used}
        # Freed at the end, as restoring the limits needs some memory, too.
        self._reserve = bytearray(_MEGABYTE)
        self._bytes_read = 0
        self.raise_for(0, 0.0, 0.0)

    def raise_for(self, byte_count: int, most_s: float, most_bytes: float) -> None:
        """Set the limits after so many bytes more were read, as :func:`raise_limits`."""
        self._bytes_read += byte_count
        megabytes = self._bytes_read / _MEGABYTE
        processor_s, memory_bytes, more_s, more_bytes = self._allowance
        self.more_memory_bytes = max(
            memory_bytes, min(memory_bytes + megabytes * more_bytes, most_bytes))
        more = {
            resource.RLIMIT_CPU: max(processor_s, min(processor_s + megabytes * more_s, most_s)),
            resource.RLIMIT_AS: self.more_memory_bytes}
        for kind, (soft, hard) in self._before.items():
            most = math.ceil(self._used[kind] + more[kind])
            # A lower limit of the user stays.
            is_of_the_user = soft != resource.RLIM_INFINITY and soft <= most
            resource.setrlimit(kind, (soft if is_of_the_user else most, hard))
            if kind == resource.RLIMIT_AS:
                self.memory_is_of_the_user = is_of_the_user

    def renew(self) -> None:
        """Count the processor time from now."""
        self._used[resource.RLIMIT_CPU] = time.process_time()
        self.raise_for(0, 0.0, 0.0)

    def end(self) -> None:
        """Restore the limits before, also if there is no memory."""
        self._reserve.clear()
        for kind, limits in self._before.items():
            resource.setrlimit(kind, limits)


def open_streams() -> None:
    """Open closed standard streams: input is empty, and output fails, as with a full disk."""
    # Otherwise, other files would get their numbers.
    for name, mode, access in (
            ('stdin', 'r', os.O_RDONLY), ('stdout', 'w', os.O_RDONLY), ('stderr', 'w', os.O_RDWR)):
        if getattr(sys, name) is None:
            setattr(sys, name, os.fdopen(os.open(os.devnull, access), mode))


_LIMITS: ContextVar[_Limits | None] = ContextVar('limits', default=None)


@contextmanager
def limited(allowance: Allowance) -> Iterator[None]:
    """
    Limit this process while the block runs.

    If the processor time is exceeded, the kernel sends SIGXCPU, which ends the process.

    :raises LimitExceededError: if a request for memory fails in the block.
    :raises MemoryError: if it fails because of a lower limit of the user.
    """
    limits = _Limits(allowance)
    token = _LIMITS.set(limits)
    try:
        yield
        return
    except MemoryError:
        limits.end()
        if limits.memory_is_of_the_user:
            raise
    finally:
        limits.end()
        _LIMITS.reset(token)
    msg = f'more than {limits.more_memory_bytes / _MEGABYTE:.0f} MB of memory'
    raise LimitExceededError(msg)


def lift_limits() -> None:
    """Restore the limits before :func:`limited`, in a process that is forked for a program."""
    limits = _LIMITS.get()
    if limits is not None:
        limits.end()


def renew_limits() -> None:
    """Allow the processor time of :func:`limited` again, for the next part of an endless input."""
    limits = _LIMITS.get()
    if limits is not None:
        limits.renew()


def raise_limits(byte_count: int, most_s: float, most_bytes: float) -> None:
    """
    Raise the limits of :func:`limited` around the caller, if any, for bytes that are read.

    :param most_s: processor time to which the limit is raised at most.
    :param most_bytes: memory to which the limit is raised at most.
    """
    limits = _LIMITS.get()
    if limits is not None:
        limits.raise_for(byte_count, most_s, most_bytes)
