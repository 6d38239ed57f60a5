# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The versions of SDFormat: which are supported, how they are written, and what they allow.

The declared version switches nothing off: what newer versions brought works in every file.
"""

from __future__ import annotations

from typing import NamedTuple

from sdf_pose_bridge.errors import ConversionError
from sdf_pose_bridge.errors import Place


class Version(NamedTuple):
    """A version of SDFormat."""

    major: int
    minor: int

    def __str__(self) -> str:
        return f'{self.major}.{self.minor}'


OLDEST = Version(1, 2)
NEWEST = Version(1, 12)


def version_numbers(text: str) -> tuple[int, ...]:
    """
    Read the numbers of a version, whether it is supported or not.

    :param text: such as ``1.10``.
    :return: its numbers, most significant first; empty if the text is not numbers with dots.
    """
    parts = text.split('.')
    if all(part.isascii() and part.isdigit() and len(part) < 6 for part in parts):
        return tuple(map(int, parts))
    return ()


def version_from_text(text: str, place: Place) -> Version:
    """
    Read a version.

    :param text: such as ``1.10``.
    :return: the version.
    :raises ConversionError: if it is older than :data:`OLDEST`, or newer than :data:`NEWEST`.
    """
    numbers = version_numbers(text)
    if len(numbers) == len(Version._fields):
        version = Version(*numbers)
        if OLDEST <= version <= NEWEST and text == str(version):
            return version
    msg = f'version="{text}" is not supported; versions {OLDEST} to {NEWEST} are'
    raise ConversionError(msg, place)


def allows_scoped_names(version: Version) -> bool:
    """
    Return whether names in a file may hold ``::``.

    :return: True below 1.8, where old libraries wrote such names.
    """
    return version < Version(1, 8)


def renames_duplicates(version: Version) -> bool:
    """
    Return whether an element is renamed that shares its name with one of another kind.

    :return: True below 1.7; in later files it is an error.
    """
    return version < Version(1, 7)
