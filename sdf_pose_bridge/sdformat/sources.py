# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The files of a load, the places of their XML elements, and problems with them.

A tree may be put together from several files.

lxml knows the line of an element, but not its file. It does not know lines beyond 65,535, nor the
first line of a start tag over several lines.
"""

from __future__ import annotations

from collections.abc import Mapping
import copy
from itertools import takewhile
from types import MappingProxyType
from typing import Any, NamedTuple

from lxml import etree

from sdf_pose_bridge.errors import Place, SdfError
from sdf_pose_bridge.printed_text import shortened
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.sdformat.limits import DEFAULT_LIMITS, Limits, Usage
from sdf_pose_bridge.sdformat.xml_tree import (
    copy_of,
    described,
    with_ancestors,
    written_tag,
    XmlElement,
)

_MOST_PLACES_KNOWN = 1000
_NUMBER_OF_ELEMENTS = etree.XPath('count(descendant-or-self::*)')

PARAMS_TAG = 'experimental:params'
"""The tag of the parameters of an include."""


class Origin(NamedTuple):
    """
    Facts about an element that its XML tree does not hold.

    The place of an included element is the place of its pose. Its content keeps its own places and
    the version of its own file.
    """

    file: str | None = None
    """Its file; None for the file of its parent."""
    include: Place | None = None
    """The include of an included element; None for its content."""
    is_named_by_include: bool = False
    """Whether its name is in the file that includes it."""
    pose_file: str | None = None
    """The file of its pose, if this is not its own file."""
    is_checked: bool = False
    """Whether the values in it were checked before it was copied to its place."""
    next_attributes: Mapping[str, str] = MappingProxyType({})
    """Attributes that apply to the next text of a pose: libsdformat has read the current one."""
    placement_frame: str = ''
    """For the frame that replaces a merged model's frame: the frame that the include places."""
    missing: Mapping[str, str] = MappingProxyType({})
    """For an include that was not replaced: its URI by the likely name of the missing model, and
    by an empty name if any unknown name may come from it."""


_PARSED = Origin()
"""The origin of an element that was parsed with its tree."""


class Sources:
    """
    The files of a load, the places of their XML elements, and problems with them.

    The file of an element is the one that :meth:`set_origin` gave to it or to its nearest
    ancestor.
    """

    def __init__(
        self, limits: Limits = DEFAULT_LIMITS, texts: Mapping[str, bytes | str] | None = None,
    ) -> None:
        self.usage = Usage(limits)
        self.texts = texts or {}
        """Texts to read instead of the files at some paths; bytes are in the encoding that they
        declare."""
        self.paths: list[str] = []
        """All files that were read, in the order of reading."""
        self.file_indices: dict[str, int] = {}
        """The index of each of them."""
        self.versions: dict[str, tuple[int, int]] = {}
        """The version of each SDFormat file by its path."""
        self.includes: dict[str, Place] = {}
        """The place of the include that first led to each included file, by its path."""
        self.may_hold_scoped_names = False
        """False if no name in these files can contain ``::``."""
        self.composed_trees: set[XmlElement] = set()
        """The outermost elements of trees whose elements have sources of their own."""
        self.problems = Problems(self.paths, self.includes)
        self._origins: dict[XmlElement, Origin] = {}
        self._lines: dict[XmlElement, int] = {}
        """The lines of elements for which lxml has another line or none."""
        self.known_places: dict[XmlElement | None, tuple[str, str]] | None = None
        """The files and paths of elements around errors, as any number of equal errors is placed;
        None while trees change."""

    def with_own_problems(self) -> Sources:
        """Return the same sources with separate problems, which are added to the load later."""
        part = copy.copy(self)
        part.problems = Problems(self.paths, hints=self.problems.hints)
        return part

    def error(
        self, error_class: type[SdfError], xml: XmlElement, message: str,
        place: Place | None = None,
    ) -> None:
        """Add an error about an element to the problems, by default with its place."""
        if self.problems.keeps_errors():
            self.problems.error(error_class(message, place or self.place(xml)))
        else:
            # The place of a deep element takes long to find.
            self.problems.count_more(errors=1, warnings=0)

    def error_in_name(self, error_class: type[SdfError], xml: XmlElement, message: str) -> None:
        """Add an error about the name of an element, which an include may have given to it."""
        self.error(error_class, xml, message, self.origin(xml).include)

    def warning(
        self, xml: XmlElement, message: str, code: str = 'WARNING', *, is_for_gazebo: bool = False,
    ) -> None:
        """Add a warning about an element, as :meth:`Problems.warning`."""
        if self.problems.keeps_warnings():
            self.problems.warning(message, self.place(xml), code, is_for_gazebo=is_for_gazebo)
        else:
            self.problems.count_more(errors=0, warnings=1)

    def check_depth(self, depth: int, xml: XmlElement) -> None:
        """Raise a LimitError if the depth of an element exceeds the limit."""
        if depth > self.usage.limits.depth:  # else its place is not worth the time
            self.usage.check('depth', depth, self.place(xml))

    def count_copy(self, xml: XmlElement, user: XmlElement) -> None:
        """Count the elements in a copy for ``user``; raise a LimitError if there are too many."""
        count = int(_NUMBER_OF_ELEMENTS(xml))
        is_refused = count > self.usage.left('copied_elements')
        self.usage.add('copied_elements', count, self.place(user) if is_refused else Place(''))

    def add_path(self, path: str) -> None:
        """Add a file, which is read once."""
        self.file_indices[path] = len(self.paths)
        self.paths.append(path)

    def add_tree(self, path: str, root: XmlElement, lines: Mapping[XmlElement, int]) -> None:
        """Add the tree of a file, and the lines of elements that lxml does not know."""
        self.set_origin(root, file=path)
        self._lines.update(lines)
        if lines:
            self.composed_trees.add(root)

    def set_source(self, xml: XmlElement, source: XmlElement, **changes: Any) -> None:
        """Give an element, with the content that has no other source, the place of another one."""
        self.set_origin(xml, file=self.path(source), **changes)
        self._lines[xml] = self.line(source)

    def set_source_of_pose(self, xml: XmlElement, source: XmlElement) -> None:
        """Give an element, but not its content, the place of another one, which has its pose."""
        self.set_origin(xml, pose_file=self.path(source))
        self._lines[xml] = self.line(source)

    def set_parsed_line(self, xml: XmlElement, source: XmlElement) -> None:
        """Give an element of a new tree the line of an element of the old one."""
        xml.sourceline = source.sourceline  # type: ignore[misc]  # it can be set
        if source in self._lines:
            self._lines[xml] = self._lines[source]

    def set_origin(self, xml: XmlElement, **changes: Any) -> None:
        """Set fields of the origin of an element."""
        known = self._origins.get(xml)
        self._origins[xml] = Origin(**changes) if known is None else known._replace(**changes)

    def origin(self, xml: XmlElement) -> Origin:
        """Return the origin of an element."""
        return self._origins.get(xml, _PARSED)

    def path(self, xml: XmlElement) -> str:
        """Return the path of the file of an element."""
        origins = (self._origins.get(each, _PARSED) for each in with_ancestors(xml))
        return next((origin.file for origin in origins if origin.file is not None), '')

    def line(self, xml: XmlElement) -> int:
        """Return the line in which an element begins, from 1; 0 if it is not known."""
        return self._lines.get(xml) or xml.sourceline or 0

    def place(self, xml: XmlElement) -> Place:
        """Return the file and the line of an element, and its path in the tree."""
        known = {} if self.known_places is None else self.known_places
        if len(known) > _MOST_PLACES_KNOWN:
            known.clear()
        for each in reversed([*takewhile(lambda each: each not in known, with_ancestors(xml))]):
            file, path = known.get(each.getparent(), ('', ''))
            known[each] = self.origin(each).file or file, f'{path}/{_step(each)}'
        file, path = known.pop(xml)  # others need its ancestors only
        return Place(self.origin(xml).pose_file or file, self.line(xml), path)

    def copy_of(self, xml: XmlElement, user: XmlElement, **changes: Any) -> XmlElement:
        """Copy an element with its content, counted, and its places and other facts."""
        self.count_copy(xml, user)
        result = copy_of(xml)
        if xml.getroottree().getroot() in self.composed_trees:
            for old, new in zip(xml.iter(), result.iter(), strict=True):
                if old in self._origins:
                    self._origins[new] = self._origins[old]
                if old in self._lines:
                    self._lines[new] = self._lines[old]
        self.set_origin(result, file=self.path(xml), **changes)
        return result


def _step(xml: XmlElement) -> str:
    """Return one step of a path; a parameter of an include has an id instead of a name."""
    element_id = xml.get('element_id')
    if element_id is None or PARAMS_TAG not in map(written_tag, xml.iterancestors()):
        return described(xml)
    return f'{written_tag(xml)}[@element_id="{shortened(element_id)}"]'
