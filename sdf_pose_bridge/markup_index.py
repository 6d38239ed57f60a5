# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The elements of a document as its text has them, together with those of its tree."""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Sequence
from typing import NamedTuple

from lxml import etree
import numpy as np

from sdf_pose_bridge.document import Document
from sdf_pose_bridge.document import XmlElement
from sdf_pose_bridge.element_rows import ElementRows
from sdf_pose_bridge.element_rows import RowTree
from sdf_pose_bridge.known_tags import KNOWN_TAGS
from sdf_pose_bridge.markup import Markup
from sdf_pose_bridge.markup import markup_from_texts
from sdf_pose_bridge.plain_values import doubtful_elements
from sdf_pose_bridge.remainder import Remainder
from sdf_pose_bridge.row_extraction import columns_from_markup
from sdf_pose_bridge.row_table import LinesOf
from sdf_pose_bridge.tag_search import Positions
from sdf_pose_bridge.tree_elements import TreeElements
from sdf_pose_bridge.versions import NEWEST
from sdf_pose_bridge.versions import Version
from sdf_pose_bridge.versions import version_of


class MarkupIndex(NamedTuple):
    """What is known of a document of which many elements are looked at at a time."""

    tree: TreeElements
    """The elements of its tree."""
    rows: Sequence[ElementRows]
    """The elements that may carry a pose, part by part."""
    doubtful: Mapping[str, Positions]
    """For each tag the elements of which the values have to be looked at one by one."""


class WrittenElements(NamedTuple):
    """The elements of a document, as a text of it has them."""

    markup: Markup
    lines_of: LinesOf
    """Tells which lines of the file they stand in."""
    version: Version
    """The version by whose rules the text is written."""


def index_of_document(document: Document, *, is_changed: bool = False) -> MarkupIndex:
    """
    Put together what is known of a document.

    :param document: a file in the newest grammar.
    :param is_changed: whether its tree differs from its text in more than the grammar.
    :return: its elements.
    """
    if document.elements is not None:
        return document.elements
    markup, lines_of, version = written_elements(document, is_changed=is_changed)
    rows = RowTree(columns_from_markup(markup, lines_of, version))
    tree = TreeElements(document.root, np.arange(len(markup.numbers)), markup.numbers)
    return MarkupIndex(tree, [ElementRows(rows, 0, tree)], doubtful_elements(markup))


def written_elements(document: Document, *, is_changed: bool = False) -> WrittenElements:
    """
    Find all elements of a document in its text, or, where that is unusual, in a new one.

    :param document: a file in the newest grammar, with its whole tree.
    :param is_changed: whether its tree differs from its text in more than the grammar.
    :return: its elements.
    """
    written = None if document.text is None else markup_from_texts([document.text])
    if written is not None and not is_changed:
        return WrittenElements(written, written.lines, version_of(document))
    # What is written here has no bracket but those of tags and comments.
    markup = markup_from_texts([etree.tostring(document.root, encoding='utf-8')])
    assert markup is not None
    if written is not None and np.array_equal(written.numbers, markup.numbers):
        return WrittenElements(markup, written.lines, NEWEST)
    lines = [xml.sourceline or 0 for xml in document.root.iter(*KNOWN_TAGS.tags)]
    assert len(lines) == len(markup.numbers), 'text and tree differ'
    return WrittenElements(markup, np.array(lines, dtype=np.int32).__getitem__, NEWEST)


def index_from_remainder(root: XmlElement, remainder: Remainder) -> MarkupIndex:
    """
    Put together what is known of a document of which only a part is in its tree.

    :param root: the outermost element of its tree.
    :param remainder: what the tree was made from.
    :return: its elements.
    """
    tree = TreeElements(root, remainder.kept, remainder.numbers)
    return MarkupIndex(
        tree, [ElementRows(rows, remainder.first_row, tree) for rows in remainder.rows],
        remainder.doubtful)
