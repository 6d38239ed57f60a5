# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The elements of a text that may carry a pose, and which of them hold which."""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Iterable
import re
from typing import NamedTuple
from typing import TYPE_CHECKING
from typing import TypeAlias

import numpy as np

from sdf_pose_bridge.document import WHITE_SPACE
from sdf_pose_bridge.elements import Indices
from sdf_pose_bridge.elements import NOWHERE
from sdf_pose_bridge.elements import Reference
from sdf_pose_bridge.known_tags import KNOWN_TAGS
from sdf_pose_bridge.markup import Markup
from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.row_kinds import CHILDREN
from sdf_pose_bridge.row_kinds import INCLUDE
from sdf_pose_bridge.row_kinds import KINDS_OF_TAGS
from sdf_pose_bridge.row_kinds import NO_KIND
from sdf_pose_bridge.row_kinds import OUTSIDE
from sdf_pose_bridge.tag_search import COMMENT
from sdf_pose_bridge.tag_search import Positions

if TYPE_CHECKING:
    import numpy.typing as npt

Flags: TypeAlias = 'npt.NDArray[np.bool_]'
Rows: TypeAlias = 'npt.NDArray[np.intp]'
LinesOf: TypeAlias = Callable[[Positions], 'npt.NDArray[np.int32]']
"""Tells which lines elements stand in."""

_MAY_HOLD = np.zeros((256, 256), dtype=bool)
for _holder, _held in CHILDREN.items():
    _MAY_HOLD[_holder, list(_held)] = True
_MAY_HOLD.setflags(write=False)

_KIND_OF_NUMBER = np.full(len(KNOWN_TAGS.tags), NO_KIND, dtype=np.uint8)
for _tag, _kind in KINDS_OF_TAGS.items():
    _KIND_OF_NUMBER[KNOWN_TAGS.number_of[_tag]] = _kind
_KIND_OF_NUMBER.setflags(write=False)
_NO_ROW = -2

_ATTRIBUTE = r'(?<![^\s=\'"])([^\s=\'"]+)\s*=\s*(?:"([^"]*)"|\'([^\']*)\')'
"""Left for `re` to compile when it is first needed."""
_ODD_IN_REFERENCES = (*WHITE_SPACE.replace('\n', ''), '\n\n', '&', COMMENT, f'\n{ROOT_FRAME}\n')
REPLACED_BY_PARSER = frozenset('&' + COMMENT)
"""Characters in the value of an element of which an XML parser makes something else."""
CHANGED_BY_PARSER = REPLACED_BY_PARSER | frozenset('\t\n\r')
"""Characters in an attribute of which it makes something else."""


class Held(NamedTuple):
    """The first child with a tag, of each row that has one."""

    rows: Rows
    """In ascending order."""
    elements: Positions
    """The child of each."""
    counts: Rows
    """How many children with the tag each has."""


class RowTable:
    """
    The rows of a document: one for each element that stands where the grammar has it.

    :param markup: the elements of the document.
    :param lines_of: tells which lines they stand in.
    """

    def __init__(self, markup: Markup, lines_of: LinesOf) -> None:
        self.markup = markup
        self.lines_of = lines_of
        kinds = _KIND_OF_NUMBER[markup.numbers]
        elements = np.flatnonzero(kinds != NO_KIND)
        kinds = kinds[elements]
        holders = markup.holders(elements)
        self._number_rows(elements)
        is_valid = _valid_rows(kinds, self.rows_of(holders))
        if not is_valid.all():
            elements, holders, kinds = elements[is_valid], holders[is_valid], kinds[is_valid]
            self._number_rows(elements)
        self.elements = elements
        """Which of the elements of the markup each row is about, in ascending order."""
        self.kinds = kinds
        """The kind of each."""
        self._padded_kinds = np.append(kinds, np.array([NO_KIND, OUTSIDE], dtype=np.uint8))
        self.parents = self.rows_of(holders)
        """The row that holds each; -1 for what stands at the top."""
        self.is_odd: Flags = kinds == INCLUDE
        """Which rows have to be looked at one by one."""

    def _number_rows(self, elements: Positions) -> None:
        self._row_of_element = np.full(len(self.markup.numbers) + 1, _NO_ROW, dtype=np.int32)
        self._row_of_element[elements] = np.arange(len(elements))
        self._row_of_element[self.markup.roots] = NOWHERE

    def rows_of(self, elements: Positions) -> Indices:
        """
        Return the rows of elements.

        :param elements: indices of elements.
        :return: the row of each; -1 for the outermost one, -2 for what has no row.
        """
        rows: Indices = self._row_of_element[elements]
        return rows

    def kinds_of(self, rows: Indices | Rows) -> npt.NDArray[np.uint8]:
        """
        Return the kinds of rows.

        :param rows: some rows; -1 and -2 as :meth:`rows_of` returns them.
        :return: the kind of each; for -1 that of the document itself, for -2 none.
        """
        return self._padded_kinds[rows]

    def of_kind(self, kind: int) -> Rows:
        """
        Find the rows of a kind.

        :param kind: the kind.
        :return: its rows, in ascending order.
        """
        return np.flatnonzero(self.kinds == kind)

    def mark_odd(self, rows: Iterable[int]) -> None:
        """
        Note that rows have to be looked at one by one.

        :param rows: some rows.
        """
        self.is_odd[list(rows)] = True

    def mark_odd_references(self, rows: Rows, names: list[str]) -> None:
        """
        Mark rows as odd that refer to something in an unusual way.

        :param rows: some rows.
        :param names: what each refers to.
        """
        joined = '\n'.join(['', *names, ''])
        if joined.count('\n') > len(names) + 1 or any(
                text in joined for text in _ODD_IN_REFERENCES):
            self.mark_odd(
                row for row, name in zip(rows.tolist(), names, strict=True)
                if not name or '\n' in name or (
                    any(text in f'\n{name}\n' for text in _ODD_IN_REFERENCES)))

    def mark_holding(self, characters: frozenset[str], rows: Rows, texts: list[str]) -> None:
        """
        Mark rows as odd about which something with certain characters is written.

        :param characters: such as :data:`REPLACED_BY_PARSER`.
        :param rows: some rows.
        :param texts: what is written about each.
        """
        joined = ''.join(texts)
        if any(character in joined for character in characters):
            self.mark_odd(row for row, text in zip(rows.tolist(), texts, strict=True)
                          if not characters.isdisjoint(text))

    def attributes(self, rows: Rows) -> list[dict[str, str]]:
        """
        Read what is written in the start tags of rows; mark those where that is unusual.

        :param rows: some rows.
        :return: the attributes of each.
        """
        tags = self.markup.tags(self.elements[rows])
        self.mark_holding(CHANGED_BY_PARSER, rows, tags)
        return [attributes_from_tag(tag) for tag in tags]

    def second_values(self, rows: Rows, attribute: str) -> list[str]:
        """
        Read an attribute that mostly comes second, behind the name.

        :param rows: some rows.
        :param attribute: its name.
        :return: its value for each; empty where it is not there.
        """
        values, has_more = self.markup.second_values(self.elements[rows], attribute.encode())
        places = np.flatnonzero(has_more)
        for place, attributes in zip(places.tolist(), self.attributes(rows[places]), strict=True):
            values[place] = attributes.get(attribute, '')
        return values

    def children(self, tag: str, kind: int) -> Held:
        """
        Find children with a tag.

        :param tag: one of the tags of the markup.
        :param kind: the kind of the rows that are asked for.
        :return: the rows of that kind that have such a child.
        """
        elements = self.markup.of(tag)
        rows = self.rows_of(self.markup.holders(elements))
        is_kind = self.kinds_of(rows) == kind
        return firsts_of_rows(rows[is_kind], elements[is_kind])

    def references(self, tag: str, kind: int) -> dict[int, Reference]:
        """
        Read what the first child with a tag says.

        :param tag: one of the tags of the markup.
        :param kind: the kind of the rows that are asked for.
        :return: for each row that has such a child its text and line.
        """
        rows, elements, _ = self.children(tag, kind)
        texts, lines = self.markup.texts(elements), self.lines_of(elements).tolist()
        return dict(zip(rows.tolist(), map(Reference, texts, lines), strict=True))


def firsts_of_rows(rows: Indices | Rows, elements: Positions) -> Held:
    """
    Find the first element of each row.

    :param rows: the row of each element.
    :param elements: indices of elements, in ascending order.
    :return: the rows that there are.
    """
    if len(rows) > 1 and (rows[1:] > rows[:-1]).all():
        return Held(rows.astype(np.intp), elements, np.ones(len(rows), dtype=np.intp))
    order = np.argsort(rows, kind='stable')
    in_order = rows[order]
    starts = np.flatnonzero(np.append(True, in_order[1:] != in_order[:-1])[:len(rows)])
    return Held(
        in_order[starts].astype(np.intp), elements[order[starts]],
        np.diff(np.append(starts, len(rows))))


def attributes_from_tag(tag: str) -> dict[str, str]:
    """
    Read what is written in a start tag.

    :param tag: what stands between its brackets.
    :return: its attributes, with the values as they are written.
    """
    return {name: a or b for name, a, b in re.findall(_ATTRIBUTE, tag)}


def _valid_rows(kinds: npt.NDArray[np.uint8], parents: Indices) -> Flags:
    """Tell which elements stand where the grammar has them, as does all that holds them."""
    holder_kinds = np.append(kinds, OUTSIDE)[np.maximum(parents, NOWHERE)]
    is_valid: Flags = _MAY_HOLD[holder_kinds, kinds] & (parents != _NO_ROW)
    count = -1
    while count != (count := int(is_valid.sum())):
        is_valid &= np.append(is_valid, True)[np.maximum(parents, NOWHERE)]
    return is_valid
