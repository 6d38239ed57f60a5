# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The elements of a document as its text has them, together with those of its tree."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from lxml import etree
import numpy as np

from sdf_pose_bridge.document import XmlElement
from sdf_pose_bridge.known_tags import KNOWN_TAGS
from sdf_pose_bridge.markup import Markup
from sdf_pose_bridge.markup import markup_from_text
from sdf_pose_bridge.markup import Positions

if TYPE_CHECKING:
    import numpy.typing as npt


class MarkupIndex:
    """
    The elements of a document that have known tags, in the order of the file.

    :param root: the outermost element of its tree, which must not change as long as this is used.
    :param written: what was found in the text that the tree was made from; None if that is not
        known.
    :param is_changed: whether the tree has changed since.
    """

    def __init__(
        self, root: XmlElement, written: Markup | None, *, is_changed: bool = False,
    ) -> None:
        self.root = root
        markup = written
        if written is None or is_changed:
            # What is written here has no bracket but those of tags and comments.
            markup = markup_from_text(etree.tostring(root, encoding='utf-8'))
        assert markup is not None
        self.markup = markup
        has_lines = written is not None and np.array_equal(written.numbers, markup.numbers)
        self._with_lines = written if has_lines else None

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
    def xmls(self, tag: str) -> list[XmlElement]:
        """
        Return the elements of the tree with a tag.

        :param tag: one of the tags.
        :return: the elements, in the order of the file.
        """
        return list(self.root.iter(tag))
    def xmls_of(self, tag: str, elements: Positions) -> list[XmlElement]:
        """
        Return some elements of the tree.

        :param tag: the tag that all of them have.
        :param elements: their indices.
        :return: the elements.
        """
        if not len(elements):
            return []
        xmls = self.xmls(tag)
        return [xmls[place] for place in np.searchsorted(self.markup.of(tag), elements).tolist()]

    @cached_property
    def _tree_lines(self) -> npt.NDArray[np.int32]:
        lines = [xml.sourceline or 0 for xml in self.root.iter(*KNOWN_TAGS.tags)]
        assert len(lines) == len(self.markup.numbers), 'text and tree differ'
        return np.array(lines, dtype=np.int32)
