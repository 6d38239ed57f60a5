# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Gather what is wrong with a file while it is read, so that a load can tell all of it at once."""

from __future__ import annotations

from sdf_pose_bridge.errors import LoadError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.errors import SdfWarning


class Problems:
    """Errors and warnings of one load, each with the element that it belongs to."""

    def __init__(self) -> None:
        self._errors: list[tuple[int, SdfError]] = []
        self._warnings: list[tuple[int, SdfWarning]] = []

    def error(self, order: int, error: SdfError) -> None:
        """
        Note an error.

        :param order: index of the element that it is about; errors are told in this order.
        :param error: the error, with its place.
        """
        self._errors.append((order, error))

    def warning(self, order: int, code: str, message: str, place: Place) -> None:
        """
        Note a warning.

        :param order: index of the element that it is about; warnings are told in this order.
        :param code: code of the error that the same thing is elsewhere, or ``WARNING``.
        :param message: one sentence.
        :param place: where it stands.
        """
        self._warnings.append((order, SdfWarning(code, message, place)))

    @property
    def warnings(self) -> tuple[SdfWarning, ...]:
        """All warnings, in file order."""
        return tuple(entry[1] for entry in sorted(self._warnings, key=lambda entry: entry[0]))

    def raise_any(self) -> None:
        """
        Do nothing if there are no errors.

        :raises LoadError: with all errors in file order, if there is one.
        """
        if self._errors:
            errors = [entry[1] for entry in sorted(self._errors, key=lambda entry: entry[0])]
            raise LoadError(errors, self.warnings)
