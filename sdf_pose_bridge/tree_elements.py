# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Find the elements of a tree that were found in its text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from sdf_pose_bridge.document import XmlElement
from sdf_pose_bridge.known_tags import KNOWN_TAGS
from sdf_pose_bridge.tag_search import Positions

if TYPE_CHECKING:
    import numpy.typing as npt


class TreeElements:
    """
    The elements of a tree that have known tags, by their indices in texts.

    :param root: its outermost element; none of these elements may be added to it or removed as
        long as this is used.
    :param numbers: the tag of each element of the texts, as a number of the known tags.
    :param elements: the indices of those that the tree has, in ascending order.
    """

    def __init__(
        self, root: XmlElement, numbers: npt.NDArray[np.int16], elements: Positions,
    ) -> None:
        self.root = root
        self.elements = elements
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
        is_wanted = np.zeros(len(KNOWN_TAGS.tags), dtype=bool)
        is_wanted[[KNOWN_TAGS.number_of[tag] for tag in tags]] = True
        candidates = self.elements[is_wanted[self._numbers[self.elements]]]
        xmls = list(self.root.iter(*tags))
        assert len(xmls) == len(candidates), 'text and tree differ'
        return [xmls[place] for place in np.searchsorted(candidates, elements).tolist()]
