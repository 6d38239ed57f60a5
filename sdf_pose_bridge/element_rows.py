# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The elements of one document that carry a pose, column by column, as they were found in its text.

Most of a large file is regular: every element has a name of its own, and nothing is wrong with it.
Such elements are told here from odd ones, which have to be looked at one by one.
"""

from __future__ import annotations

from collections.abc import Iterator
from collections.abc import Sequence
import itertools
from typing import Any
from typing import NamedTuple
from typing import TYPE_CHECKING
from typing import TypeAlias

import numpy as np

from sdf_pose_bridge.document import XmlElement
from sdf_pose_bridge.elements import Indices
from sdf_pose_bridge.elements import NOWHERE
from sdf_pose_bridge.row_kinds import TOP_TAGS
from sdf_pose_bridge.tree_elements import TreeElements

if TYPE_CHECKING:
    import numpy.typing as npt

_Rows: TypeAlias = 'npt.NDArray[np.intp]'


class Facts(NamedTuple):
    """What only some rows have."""

    rows: _Rows
    """In ascending order."""
    values: Sequence[Any]

    def copy_to(self, target: dict[int, Any], start: int, end: int, offset: int) -> None:
        """
        Copy what some rows have.

        :param target: takes it.
        :param start: the first of the rows.
        :param end: the row after the last.
        :param offset: what to add to a row to get its key.
        """
        first, last = np.searchsorted(self.rows, (start, end)).tolist()
        if first < last:
            target.update(zip(
                (self.rows[first:last] + offset).tolist(), self.values[first:last], strict=True))


class Run(NamedTuple):
    """Siblings that follow one another, with all that they hold."""

    is_regular: bool
    """False for a single one that is odd, or holds something odd."""
    start: int
    end: int
    """The row after the last."""
    children: _Rows
    """The rows of the siblings themselves."""


class Columns(NamedTuple):
    """
    What is known of each row; entry i of each sequence and array is about row i.

    Rows stand in the order of the files. What is said of odd ones may be wrong.
    """

    elements: _Rows
    """Which of the elements of the texts each row is about, in ascending order."""
    names: list[str]
    kinds: npt.NDArray[np.uint8]
    parents: Indices
    """The row that holds each; -1 for what stands at the top."""
    scopes: Indices
    """The model or world whose names the references of each use; -1 at the top."""
    lines: Indices
    pose_lines: Indices
    is_odd: npt.NDArray[np.bool_]
    has_odd_name: npt.NDArray[np.bool_]
    """Which of the odd ones may be called otherwise than is said here."""
    posed: _Rows
    """The rows that have a pose, in ascending order."""
    texts: list[str]
    """Their poses."""
    quaternions: _Rows
    """Which of the texts are quaternions."""
    degrees: _Rows
    """Which of the texts are in degrees."""
    relative_to: Facts
    models: Facts
    frames: Facts
    joints: Facts
    sensors: Facts


class RowTree:
    """
    Which rows hold which.

    :param columns: what is known of each row, of one document or of several.
    """

    def __init__(self, columns: Columns) -> None:
        self.columns = columns
        parents = columns.parents
        self._odd_before = np.append(0, np.cumsum(columns.is_odd))
        self._by_parent = np.argsort(parents, kind='stable')
        # What stands at the top comes first; children of row i are between entries i + 1, i + 2.
        self._first_children = np.searchsorted(
            parents[self._by_parent], np.arange(-1, len(parents) + 1))

    def children(self, row: int) -> _Rows:
        """
        Return what a row holds itself.

        :param row: the row; -1 for what stands at the top of the documents.
        :return: other rows, in ascending order.
        """
        first, last = self._first_children[row + 1:row + 3].tolist()
        children: _Rows = self._by_parent[first:last]
        return children

    def runs(self, row: int) -> Iterator[Run]:
        """
        Go through what a row holds.

        :param row: a model or world.
        :return: runs of regular rows, and between them the rows that are odd or hold something
            odd, in the order of the file.
        """
        children = self.children(row)
        if not len(children):
            return
        ends = np.append(children[1:], self._end_of(row))
        is_odd = self._odd_before[ends] > self._odd_before[children]
        borders = np.flatnonzero(is_odd[1:] | is_odd[:-1]) + 1
        for begin, end in itertools.pairwise([0, *borders.tolist(), len(children)]):
            yield Run(
                not is_odd[begin], int(children[begin]), int(ends[end - 1]), children[begin:end])

    def _end_of(self, row: int) -> int:
        """Return the row after the last that a row holds."""
        while row >= 0:
            parent = int(self.columns.parents[row])
            siblings = self.children(parent)
            following = int(np.searchsorted(siblings, row, side='right'))
            if following < len(siblings):
                return int(siblings[following])
            row = parent
        return len(self.columns.names)


class ElementRows:
    """
    Rows of one document, and the elements of its tree that they are about.

    :param rows: some or all of its rows, and maybe those of others.
    :param first: the first of its rows.
    :param tree: the elements of its tree.
    """

    def __init__(self, rows: RowTree, first: int, tree: TreeElements) -> None:
        self.columns = rows.columns
        self._rows = rows
        self._first = first
        self._tree = tree

    def row_of(self, xml: XmlElement) -> int:
        """
        Find the row of an element.

        :param xml: an element of the document.
        :return: its row; -1 if it is not among these.
        """
        root, elements = self._tree.root, self.columns.elements
        if xml.getparent() is root:
            # Much quicker than to make an object for each element of the tree.
            place = list(root.iterchildren(*TOP_TAGS)).index(xml)
            tops = self._rows.children(NOWHERE)
            return int(tops[np.searchsorted(tops, self._first) + place])
        element = self._tree.element_of_row_xml[xml]
        row = int(np.searchsorted(elements, element))
        return row if row < len(elements) and elements[row] == element else NOWHERE

    def xmls(self, rows: _Rows) -> list[XmlElement]:
        """
        Return the elements of the tree that rows are about.

        :param rows: some rows.
        :return: the elements.
        """
        return [self._tree.row_xmls[element] for element in self.columns.elements[rows].tolist()]

    def runs(self, xml: XmlElement) -> Iterator[Run]:
        """
        Go through what a model or a world holds.

        :param xml: a model or world of the document.
        :return: as :meth:`RowTree.runs` does; nothing if none of it is among these rows.
        """
        row = self.row_of(xml)
        return iter(()) if row == NOWHERE else self._rows.runs(row)
