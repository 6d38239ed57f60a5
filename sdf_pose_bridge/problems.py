# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Gather the errors and warnings of a load."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import count
from typing import TypeVar

from sdf_pose_bridge.errors import (
    FileReadError,
    LimitError,
    LoadError,
    Place,
    SdfError,
    SdfWarning,
    shortened_message,
    TemporaryReadError,
)
from sdf_pose_bridge.limited_process import ProcessEndedError
from sdf_pose_bridge.printed_text import listed
from sdf_pose_bridge.process_limits import LimitExceededError

MOST_PROBLEMS = 100
"""Largest number of errors, and of warnings, that a load keeps."""

MOST_HINTS = 50
"""Largest number of messages of a load that suggest a name."""

_LONGEST_CHAIN = 10
"""Largest number of includes that an error names on the way to a file."""

_Problem = TypeVar('_Problem', bound=SdfError | SdfWarning)


class Problems:
    """
    The errors and warnings of one load.

    The first hundred of each are kept, and the rest is counted. Problems of a file that is
    included twice are kept once. Messages are shortened where they are made.

    :param paths: the files that are read, in the order of reading; it may grow.
    :param includes: the place of the include that first led to each included file; it may grow.
    :param hints: counts messages that suggest a name; a part of a load has that of the whole.
    """

    def __init__(
        self, paths: Sequence[str], includes: Mapping[str, Place] | None = None,
        hints: Iterator[int] | None = None,
    ) -> None:
        self._paths = paths
        self._includes = {} if includes is None else includes
        self._errors = _First[SdfError]()
        self._warnings = _First[SdfWarning]()
        self.hints = count(1) if hints is None else hints
        self.error_count = 0
        """Number of errors that were added, with those that are not kept."""
        self.are_for_gazebo = False
        """Whether all warnings from now on concern Gazebo only."""

    def error(self, error: SdfError) -> None:
        """Add an error."""
        self.error_count += 1
        self._errors.add(error, self._key(error))

    def warning(
        self, message: str, place: Place, code: str = 'WARNING', *, is_for_gazebo: bool = False,
    ) -> None:
        """Add a warning; the arguments are the fields of :class:`SdfWarning`."""
        warning = SdfWarning(
            code, shortened_message(message), place, is_for_gazebo or self.are_for_gazebo)
        self._warnings.add(warning, self._key(warning))

    def extend(self, problems: Iterable[SdfError | SdfWarning]) -> None:
        """Add errors and warnings."""
        for problem in problems:
            if isinstance(problem, SdfError):
                self.error(problem)
            else:
                self.warning(
                    problem.message, problem.place, problem.code,
                    is_for_gazebo=problem.is_for_gazebo)

    def add_part(self, part: Problems) -> None:
        """Add the errors and warnings of a part of the load."""
        self.extend([*part._errors.values(), *part._warnings.values()])
        self.count_more(part._errors.more, part._warnings.more)

    def count_more(self, errors: int, warnings: int) -> None:
        """Count problems without keeping them."""
        self._errors.more += errors
        self.error_count += errors
        self._warnings.more += warnings

    def keeps_errors(self) -> bool:
        """Return whether another error would be kept."""
        return len(self._errors) < MOST_PROBLEMS

    def keeps_warnings(self) -> bool:
        """Return whether another warning would be kept."""
        return len(self._warnings) < MOST_PROBLEMS

    def allows_hint(self) -> bool:
        """Return whether a message may end in a hint, and count it."""
        return next(self.hints) <= MOST_HINTS

    @property
    def errors(self) -> tuple[SdfError, ...]:
        """
        The errors by file and line; the last one counts those that were not kept.

        The first error of an included file names the includes on the way there.
        """
        errors = self._in_order(self._errors.values())
        seen = set()
        for index, error in enumerate(errors):
            if error.file not in seen and error.file in self._includes:
                errors[index] = type(error)(
                    f'{error.message}{self._included_from(error.file)}', error.place)
            seen.add(error.file)
        if self._errors.more:
            errors.append(SdfError(f'and {self._errors.more} more errors', Place(self._paths[0])))
        return tuple(errors)

    @property
    def warnings(self) -> tuple[SdfWarning, ...]:
        """The warnings by file and line; the last one counts those that were not kept."""
        warnings = self._in_order(self._warnings.values())
        if self._warnings.more:
            warnings.append(SdfWarning(
                'WARNING', f'and {self._warnings.more} more warnings', Place(self._paths[0])))
        return tuple(warnings)

    def raise_errors(self) -> None:
        """Raise the errors with the warnings, if there are any."""
        if self._errors:
            raise LoadError(self.errors, self.warnings)

    def _key(self, problem: SdfError | SdfWarning) -> Hashable:
        place = problem.place
        if not self._paths or place.file != self._paths[0]:
            # An element of an included file has another path for each include.
            place = place._replace(element='')
        return problem.code, problem.message, place

    def _in_order(self, problems: Iterable[_Problem]) -> list[_Problem]:
        ranks = {path: rank for rank, path in enumerate(self._paths)}
        return sorted(problems, key=lambda problem: (
            ranks.get(problem.place.file, len(ranks)), problem.place.line))

    def _included_from(self, file: str) -> str:
        steps: list[str] = []
        while file in self._includes and len(steps) < _LONGEST_CHAIN:
            steps.append(f'included from {self._includes[file]}')
            file = self._includes[file].file
        return f' ({", ".join(steps)})'


def by_message(problems: Iterable[_Problem]) -> Iterator[tuple[_Problem, str]]:
    """
    Join the problems of one file that have the same message.

    :return: an iterator over the first problem of each message, with a text about the lines of the
        others; '' if there are none.
    """
    groups: dict[Hashable, list[_Problem]] = {}
    for problem in problems:
        key = (problem.place.file, problem.code, problem.message)
        groups.setdefault(key, []).append(problem)
    for first, *others in groups.values():
        lines = listed([str(each.place.line) for each in others])
        yield first, f' (also line{"s" if others[1:] else ""} {lines})' if others else ''


@contextmanager
def errors_of_process(file: str) -> Iterator[None]:
    """
    Raise errors of a process that reads a file as errors of the file.

    :raises LimitError: if reading the file exceeds the limits.
    :raises FileReadError: if the process ends during the call, or cannot be started, or there is
        no memory for its answer.
    """
    place = Place(file)
    try:
        yield
    except LimitExceededError as error:
        msg = f'the file needs {error} to be read'
        raise LimitError(msg, place) from None
    except ProcessEndedError as error:
        error_class = TemporaryReadError if error.is_temporary else FileReadError
        raise error_class(str(error), place) from error


class _First(dict[Hashable, _Problem]):
    """The first problems of a kind by their keys; ``more`` is the number of the others."""

    more = 0

    def add(self, problem: _Problem, key: Hashable) -> None:
        if len(self) < MOST_PROBLEMS:
            self.setdefault(key, problem)
        elif key not in self:
            self.more += 1
