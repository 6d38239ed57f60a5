# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Gather what is wrong with a file while it is read, so that a load can tell all of it at once."""

from __future__ import annotations

from collections.abc import Iterable
from collections.abc import Sequence
from typing import Protocol
from typing import TypeVar

from sdf_pose_bridge.errors import LoadError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.errors import SdfWarning


class _Problem(Protocol):

    @property
    def code(self) -> str: ...
    @property
    def message(self) -> str: ...
    @property
    def place(self) -> Place: ...


_AnyProblem = TypeVar('_AnyProblem', bound=_Problem)


class Problems:
    """
    Errors and warnings of one load.

    :param files: the files that are read, the first one first; problems are told in this order,
        and by line within each.
    """

    def __init__(self, files: Iterable[str]) -> None:
        self._ranks = {path: rank for rank, path in enumerate(files)}
        self._errors: list[SdfError] = []
        self._warnings: list[SdfWarning] = []

    def error(self, error: SdfError) -> None:
        """
        Note an error.

        :param error: the error, with its place.
        """
        self._errors.append(error)

    def warning(self, code: str, message: str, place: Place) -> None:
        """
        Note a warning.

        :param code: code of the error that the same thing is elsewhere, or ``WARNING``.
        :param message: one sentence.
        :param place: where it stands.
        """
        self._warnings.append(SdfWarning(code, message, place))

    def extend(self, other: Problems) -> None:
        """
        Take over what another collection holds.

        :param other: the other collection.
        """
        self._errors += other.errors
        self._warnings += other.warnings

    @property
    def errors(self) -> tuple[SdfError, ...]:
        """All errors, each once however often its file is included, in the order of the files."""
        return tuple(self._in_order(self._errors))

    @property
    def warnings(self) -> tuple[SdfWarning, ...]:
        """All warnings, as for :attr:`errors`."""
        return tuple(self._in_order(self._warnings))

    def raise_any(self) -> None:
        """
        Do nothing if there are no errors.

        :raises LoadError: with all errors and warnings, if there is an error.
        """
        if self._errors:
            raise LoadError(self.errors, self.warnings)

    def _in_order(self, problems: Sequence[_AnyProblem]) -> list[_AnyProblem]:
        once: dict[tuple[str, str, Place], _AnyProblem] = {}
        last = len(self._ranks)
        for problem in problems:
            place = problem.place
            if self._ranks.get(place.file, last):
                # What is included many times is another element each time.
                place = place._replace(element='')
            once.setdefault((problem.code, problem.message, place), problem)
        return sorted(once.values(), key=lambda problem: (
            self._ranks.get(problem.place.file, last), problem.place.line))
