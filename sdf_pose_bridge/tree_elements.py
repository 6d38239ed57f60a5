# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Find the elements of a tree that were found in its text."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from sdf_pose_bridge.document import XmlElement
from sdf_pose_bridge.known_tags import KNOWN_TAGS
from sdf_pose_bridge.row_kinds import ROW_TAGS
from sdf_pose_bridge.tag_search import Positions

if TYPE_CHECKING:
    import numpy.typing as npt


class TreeElements:
    """
    The elements of a tree that have known tags, by their indices in texts.

    :param root: its outermost element; none of these elements may be added to it or removed as
        long as this is used.
    :param elements: the indices of those that the tree has, in ascending order.
    :param numbers: the tag of each of these, as a number of the known tags.
    """

    def __init__(
        self, root: XmlElement, elements: Positions, numbers: npt.NDArray[np.int16],
    ) -> None:
        self.root = root
        self._elements = elements
        self._numbers = numbers

    def xmls_of(self, tags: Sequence[str], elements: Positions) -> list[XmlElement]:
        """
        Return some elements of the tree.

        :param tags: the tags that they have.
        :param elements: their indices.
        :return: the elements.
        """
        if not len(elements):
            return []
        candidates, xmls = self._with_tags(tags)
        return [xmls[place] for place in np.searchsorted(candidates, elements).tolist()]

    @cached_property
    def row_xmls(self) -> dict[int, XmlElement]:
        """The elements that may carry a pose, by their indices."""
        elements, xmls = self._with_tags(ROW_TAGS)
        return dict(zip(elements.tolist(), xmls, strict=True))

    @cached_property
    def element_of_row_xml(self) -> dict[XmlElement, int]:
        """The indices of the elements that may carry a pose."""
        return {xml: element for element, xml in self.row_xmls.items()}

    def _with_tags(self, tags: Sequence[str]) -> tuple[Positions, list[XmlElement]]:
        is_wanted = np.zeros(len(KNOWN_TAGS.tags), dtype=bool)
        is_wanted[[KNOWN_TAGS.number_of[tag] for tag in tags]] = True
        elements = self._elements[is_wanted[self._numbers]]
        xmls = list(self.root.iter(*tags))
        assert len(xmls) == len(elements), 'text and tree differ'
        return elements, xmls
