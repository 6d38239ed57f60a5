# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The elements of a document as its text has them, together with those of its tree."""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING

from lxml import etree
import numpy as np

from sdf_pose_bridge.document import Document
from sdf_pose_bridge.document import XmlElement
from sdf_pose_bridge.element_rows import Columns
from sdf_pose_bridge.element_rows import ElementRows
from sdf_pose_bridge.known_tags import KNOWN_TAGS
from sdf_pose_bridge.markup import Markup
from sdf_pose_bridge.markup import markup_from_text
from sdf_pose_bridge.markup import Positions
from sdf_pose_bridge.plain_values import doubtful_elements
from sdf_pose_bridge.row_extraction import columns_from_markup
from sdf_pose_bridge.row_table import ROW_TAGS
from sdf_pose_bridge.row_table import TOP_TAGS
from sdf_pose_bridge.versions import NEWEST
from sdf_pose_bridge.versions import Version
from sdf_pose_bridge.versions import version_of

if TYPE_CHECKING:
    import numpy.typing as npt

    from sdf_pose_bridge.remainder import Remainder


class MarkupIndex:
    """
    The elements of a document that have known tags, in the order of the file.

    :param root: the outermost element of its tree; none of these elements may be added to it or
        removed as long as this is used.
    :param markup: what was found in a text of it.
    :param version: the version by whose rules that text is written.
    :param with_lines: the same elements where they stand in the file; None if only the tree has
        their lines.
    :param remainder: what of the text the tree has; None for all.
    """

    def __init__(
        self,
        root: XmlElement,
        markup: Markup,
        version: Version,
        *,
        with_lines: Markup | None,
        remainder: Remainder | None = None,
    ) -> None:
        self.markup = markup
        self._root = root
        self._version = version
        self._with_lines = with_lines
        self._remainder = remainder

    def lines(self, elements: Positions) -> npt.NDArray[np.int32]:
        """
        Tell which lines elements stand in.

        :param elements: their indices.
        :return: the line in which the start tag of each ends, the first one being 1.
        """
        if self._with_lines is not None:
            return self._with_lines.lines(elements)
        lines: npt.NDArray[np.int32] = self._tree_lines[elements]
        return lines

    @cached_property
    def doubtful(self) -> Mapping[str, Positions]:
        """For each tag the elements of which the values have to be looked at one by one."""
        if self._remainder is not None:
            return self._remainder.doubtful
        return doubtful_elements(self.markup)

    @cached_property
    def rows(self) -> ElementRows:
        """The elements that may carry a pose."""
        columns = self._columns()
        return ElementRows(columns, self._root, TOP_TAGS, lambda: self._xmls_of_rows(columns))

    def xmls_of(self, tags: Sequence[str], elements: Positions) -> list[XmlElement]:
        """
        Return some elements of the tree.

        :param tags: the tags that they have.
        :param elements: their indices, of elements that the tree has.
        :return: the elements.
        """
        if not len(elements):
            return []
        candidates = np.sort(np.concatenate([self.markup.of(tag) for tag in tags]))
        if self._remainder is not None:
            candidates = candidates[self._remainder.is_kept[candidates]]
        xmls = list(self._root.iter(*tags))
        assert len(xmls) == len(candidates), 'text and tree differ'
        return [xmls[place] for place in np.searchsorted(candidates, elements).tolist()]

    def _columns(self) -> Columns:
        if self._remainder is not None:
            return self._remainder.columns
        return columns_from_markup(self.markup, self.lines, self._version)

    def _xmls_of_rows(self, columns: Columns) -> tuple[Positions, list[XmlElement]]:
        rows = np.arange(len(columns.names))
        if self._remainder is not None:
            rows = rows[self._remainder.is_kept[columns.elements]]
        return rows, self.xmls_of(ROW_TAGS, columns.elements[rows])

    @cached_property
    def _tree_lines(self) -> npt.NDArray[np.int32]:
        lines = [xml.sourceline or 0 for xml in self._root.iter(*KNOWN_TAGS.tags)]
        assert len(lines) == len(self.markup.numbers), 'text and tree differ'
        return np.array(lines, dtype=np.int32)


def index_of_document(document: Document, *, is_changed: bool = False) -> MarkupIndex:
    """
    Find the elements of a document.

    :param document: a file in the newest grammar.
    :param is_changed: whether its tree differs from its text in more than the grammar.
    :return: its elements.
    """
    if document.elements is not None:
        return document.elements
    written = None if document.text is None else markup_from_text(document.text)
    if written is not None and not is_changed:
        return MarkupIndex(
            document.root, written, version_of(document), with_lines=written)
    # What is written here has no bracket but those of tags and comments.
    markup = markup_from_text(etree.tostring(document.root, encoding='utf-8'))
    assert markup is not None
    has_lines = written is not None and np.array_equal(written.numbers, markup.numbers)
    return MarkupIndex(
        document.root, markup, NEWEST, with_lines=written if has_lines else None)
