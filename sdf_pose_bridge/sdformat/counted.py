# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Copies and look-ups that a few bytes can request, counted against the limits of a load.

No other module copies trees, follows links or lists directories; ``make lint`` checks this. So a
file that requests them again and again reaches a limit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
import copy
import errno
from itertools import chain
import os
from typing import NamedTuple

from lxml import etree

from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.sdformat.limits import (
    CHARACTERS_OF_STEP,
    STEPS_OF_ELEMENT,
    STEPS_OF_NAMED_ELEMENT,
    Usage,
)
from sdf_pose_bridge.sdformat.xml_tree import XmlElement

_COUNTS = tuple(etree.XPath(f'count({path})') for path in (
    'descendant-or-self::*', 'descendant-or-self::*[@name]', 'descendant::node()',
    'descendant-or-self::*/@*'))
"""Counts all elements, elements with a name, nodes and attributes of a copied element."""

_MOST_LINKS = 40
"""Largest number of links that lead to one another, as in Linux."""

_LONGEST_PATH = 4095
"""Largest number of bytes of a path, as in Linux."""

_CHARACTERS_OF_WALK = 8
"""Following a path costs one step per this many characters."""

_STEPS_OF_LOOK = 2
"""Steps to look at a file or directory for the first time."""

_CHARACTERS_OF_LOOK = 64
"""The same costs one more step per this many characters of its path."""


def steps_of_copy(xml: XmlElement) -> int:
    """Return the steps of work to copy an element with its content and to read the copy."""
    if not len(xml):
        # For example a pose, which many includes have.
        characters = len(xml.text or '') + sum(map(len, chain(xml.keys(), xml.values())))
        return STEPS_OF_ELEMENT * (1 + len(xml.attrib)) + characters // CHARACTERS_OF_STEP
    elements, named, nodes, attributes = (int(count(xml)) for count in _COUNTS)
    # Mostly the first is the largest: few elements have long texts, or comments between them.
    return max(
        STEPS_OF_ELEMENT * elements + STEPS_OF_NAMED_ELEMENT * named,
        STEPS_OF_ELEMENT * (nodes + attributes),
        len(etree.tostring(xml, with_tail=False)) // CHARACTERS_OF_STEP)


def copy_of(
    xml: XmlElement, usage: Usage, place: Place | Callable[[], Place], steps: int | None = None,
) -> XmlElement:
    """
    Copy an element with its content, without the text behind it.

    :param place: the place that requests the copy.
    :param steps: the result of :func:`steps_of_copy` for it, if known.
    :raises LimitError: if this exceeds the work of the load.
    """
    usage.add('work', steps_of_copy(xml) if steps is None else steps, place)
    # lxml also copies the text behind the element, which has no meaning and can be longer.
    xml.tail = None
    return copy.deepcopy(xml)


class _TooManyLinksError(Exception):
    """Too many links lead to one another."""


class FileLookups(NamedTuple):
    """
    Looks up files for one load, each file, link and directory once.

    Paths in files can be long, and lead over even longer links. So links are followed here and not
    by the system, which does not report the length of the way.
    """

    usage: Usage
    place: Place
    """The place that requests the look-ups."""
    paths: dict[str, str | None]
    """:meth:`real_path` by path."""
    steps: dict[str, str | None]
    """The same for paths in which only the last part can be a link."""
    directories: dict[str, bool]
    """Whether a real path is a directory."""
    lists: dict[str, Mapping[str, str]]
    """:meth:`entries` by directory."""

    def real_path(self, path: str) -> str | None:
        """Return the path of a file or directory without links; None if it does not exist."""
        self.usage.add('work', 1, self.place)
        try:
            if len(os.fsencode(path)) > _LONGEST_PATH:
                return None
            return self._followed(
                path if path.startswith('/') else f'{os.getcwd()}/{path}', 0)  # noqa: PTH109
        except (FileNotFoundError, UnicodeEncodeError, _TooManyLinksError):
            return None

    def is_directory(self, path: str) -> bool:
        """Return whether a path is a directory."""
        real_path = self.real_path(path)
        return real_path is not None and self._is_directory(real_path)

    def entries(self, directory: str) -> Mapping[str, str]:
        """Return the names in a directory by their lower case; empty if it cannot be read."""
        if directory not in self.lists:
            try:
                names = os.listdir(directory)  # noqa: PTH208
            except (OSError, ValueError):  # ValueError: a zero character
                names = []
            self.usage.add('work', len(names), self.place)
            # If names differ in case only, the first one counts.
            self.lists[directory] = {name.lower(): name for name in reversed(names)}
        return self.lists[directory]

    def _followed(self, path: str, link_count: int) -> str | None:
        if path not in self.paths:
            self.usage.add('work', len(path) // _CHARACTERS_OF_WALK, self.place)
            self.paths[path] = self._walked(path, link_count)
        return self.paths[path]

    def _walked(self, path: str, link_count: int) -> str | None:
        real_path = ''
        for name in path.split('/'):
            if name in ('', '.', '..'):
                if not self._is_directory(real_path or '/'):
                    return None
                if name == '..':
                    real_path = real_path.rpartition('/')[0]
                continue
            step = f'{real_path}/{name}'
            if step not in self.steps:
                self.steps[step] = self._end_of_step(step, link_count)
            end = self.steps[step]
            if end is None:
                return None
            real_path = end.rstrip('/')
        return real_path or '/'

    def _end_of_step(self, step: str, link_count: int) -> str | None:
        self._count_look(step)
        try:
            target = os.readlink(step)  # noqa: PTH115
        except OSError as error:
            return step if error.errno == errno.EINVAL else None  # EINVAL: not a link
        except ValueError:  # a zero character
            return None
        if link_count == _MOST_LINKS:
            # Do not remember any part of this path, as its end may exist.
            raise _TooManyLinksError
        folder = step.rpartition('/')[0]
        return self._followed(
            target if target.startswith('/') else f'{folder}/{target}', link_count + 1)

    def _count_look(self, path: str) -> None:
        self.usage.add('work', _STEPS_OF_LOOK + len(path) // _CHARACTERS_OF_LOOK, self.place)

    def _is_directory(self, path: str) -> bool:
        if path not in self.directories:
            self._count_look(path)
            self.directories[path] = os.path.isdir(path)  # noqa: PTH112
        return self.directories[path]


def file_lookups(usage: Usage | None = None, place: Place = Place('')) -> FileLookups:  # noqa: B008
    """Return empty look-ups, which count as work of a load."""
    return FileLookups(Usage() if usage is None else usage, place, {}, {}, {}, {})
