# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Find elements in the texts of documents, many at a time.

If a parser finds a text to be well-formed, a few bytes tell what there is: where tags begin and
end, what they are called, and how deep they stand. That takes a fraction of the time of asking
each element of the tree, and makes no object for each.
"""

from __future__ import annotations

from collections.abc import Iterable
from collections.abc import Sequence
from typing import NamedTuple
from typing import TYPE_CHECKING
from typing import TypeAlias

import numpy as np

from sdf_pose_bridge.known_tags import KNOWN_TAGS
from sdf_pose_bridge.tag_names import UNKNOWN
from sdf_pose_bridge.tag_names import WIDTH
from sdf_pose_bridge.tag_names import words_from_text
from sdf_pose_bridge.tag_search import COMMENT
from sdf_pose_bridge.tag_search import places
from sdf_pose_bridge.tag_search import Positions
from sdf_pose_bridge.tag_search import Tags
from sdf_pose_bridge.tag_search import tags_from_texts

if TYPE_CHECKING:
    import numpy.typing as npt

_NAME_LENGTHS = np.array([1 + len(tag) for tag in KNOWN_TAGS.tags])
_NAME_LENGTHS.setflags(write=False)

_PIECES = 1 << 13

_Flags: TypeAlias = 'npt.NDArray[np.bool_]'


class Spans(NamedTuple):
    """Where elements stand, with all that they hold."""

    begins: Positions
    """Where each start tag begins."""
    ends: Positions
    """Where what follows each begins."""
    first_tags: Positions
    """Which of all tags each begins with."""
    last_tags: Positions
    """Which of all tags each ends with."""


class Markup:
    """
    The elements with known tags that one or more texts have, in their order.

    :param tags: all tags of the texts.
    """

    def __init__(self, tags: Tags) -> None:
        _, self.starts, roots, begins, ends, is_closing, _, depths, part, _ = tags
        self._all_tags = tags
        self._buffer = np.frombuffer(tags.text, np.uint8)
        self._words = words_from_text(self._buffer)
        starts = np.flatnonzero(~is_closing)
        numbers = KNOWN_TAGS.numbers_from_text(self._buffer, begins[starts] + 1)
        self._depths = depths[starts]
        self._ordinals = np.flatnonzero(numbers != UNKNOWN)
        self.numbers: npt.NDArray[np.int16] = numbers[self._ordinals]
        """The tag of each element, as a number of the known tags."""
        self._tags = chosen = starts[self._ordinals]
        self._begins = begins[chosen]
        self._ends = ends[chosen]
        self.roots = np.searchsorted(chosen, roots)
        """The outermost element of each text, where all of these have known tags."""
        self._by_number = np.argsort(self.numbers, kind='stable')
        self._firsts: list[int] = np.searchsorted(
            self.numbers[self._by_number], np.arange(len(KNOWN_TAGS.tags) + 1)).tolist()
        # What stands around a part of the text stands before it.
        head = self._buffer[:min(part.start, int(ends[min(1, len(ends) - 1)]) + 1)]
        rest = self._buffer[part]
        # The last one stands for all that are not there.
        self._quotes = np.concatenate([places(head, '"'), places(rest, '"') + part.start, [0]])
        self._newlines = np.append(places(head, '\n'), places(rest, '\n') + part.start)
        self._newlines_before = np.searchsorted(self._newlines, self.starts)
        self._newlines_between = tags.newlines_before - len(places(head, '\n'))
        # All elements in the order of their depths, and where each depth begins.
        self._by_depth = np.argsort(self._depths, kind='stable')
        self._depth_borders: list[int] = [0, *np.cumsum(np.bincount(self._depths)).tolist()]

    @property
    def begins(self) -> Positions:
        """Where the start tag of each element begins."""
        return self._begins

    def are_in_part(self, elements: Positions) -> _Flags:
        """
        Tell which elements do not stand around the part of the text that these tags are of.

        :param elements: their indices.
        :return: true for those that stand in the part.
        """
        is_inside: _Flags = self._begins[elements] >= self._all_tags.part.start
        return is_inside

    def spans(self, elements: Positions) -> Spans:
        """
        Tell where elements begin and end.

        :param elements: their indices.
        :return: their places.
        """
        tags, first_tags = self._all_tags, self._tags[elements]
        last_tags = first_tags.copy()
        depths = np.where(tags.is_empty[first_tags], -1, tags.depths[first_tags])
        for depth in (np.flatnonzero(np.bincount(depths + 1)[1:])).tolist():
            here = np.flatnonzero(depths == depth)
            closing = np.flatnonzero(tags.is_closing & (tags.depths == depth + 1))
            last_tags[here] = closing[np.searchsorted(closing, first_tags[here])]
        return Spans(tags.begins[first_tags], tags.ends[last_tags] + 1, first_tags, last_tags)

    def newlines_between(self, begins: Positions, ends: Positions) -> Positions:
        """
        Count the lines that parts of the text go over.

        :param begins: where each part begins.
        :param ends: where what follows each begins.
        :return: the number of line ends in each.
        """
        counts: Positions = np.searchsorted(self._newlines, ends) - np.searchsorted(
            self._newlines, begins)
        return counts

    def present(self, tags: Iterable[str]) -> list[str]:
        """
        Choose the tags that there are.

        :param tags: some of the tags.
        :return: those that any element has.
        """
        firsts, number_of = self._firsts, KNOWN_TAGS.number_of
        return [tag for tag in tags if firsts[number_of[tag]] < firsts[number_of[tag] + 1]]

    def of(self, tag: str) -> Positions:
        """
        Find the elements with a tag.

        :param tag: one of the tags.
        :return: their indices, in ascending order.
        """
        number = KNOWN_TAGS.number_of[tag]
        return self._by_number[self._firsts[number]:self._firsts[number + 1]]

    def texts(self, elements: Positions) -> list[str]:
        """
        Return the first run of character data in elements, as it is written.

        :param elements: their indices.
        :return: the text of each, up to the first tag, with
            :data:`~sdf_pose_bridge.tag_search.COMMENT` for comments, and with
            characters written as ``&...;`` left as they are.
        """
        return self._cut(self._ends[elements] + 1, self._text_ends(elements))

    def begins_with_digit(self, elements: Positions) -> _Flags:
        """
        Tell whether the text of elements begins with a digit.

        :param elements: their indices.
        :return: true for those of which the first character is one.
        """
        first = self._buffer[self._ends[elements] + 1]
        is_digit: _Flags = (first >= ord('0')) & (first <= ord('9'))
        return is_digit

    def counts_of_numbers(self, elements: Positions) -> Positions:
        """
        Count the words in the texts of elements, as far as all of them begin with digits.

        :param elements: their indices.
        :return: the number of words in each; 0 where a word begins otherwise, or there is a
            comment.
        """
        # With the bracket that follows each text, which ends its last word.
        begins = self._ends[elements] + 1
        lengths = np.maximum(self._text_ends(elements) + 1 - begins, 1)
        firsts: Positions = np.cumsum(lengths) - lengths
        if not len(firsts):
            return firsts
        characters = self._buffer[
            np.repeat(begins - firsts, lengths) + np.arange(int(lengths.sum()))]
        is_gap = (characters <= ord(' ')) | (characters == ord('<'))
        is_first = ~is_gap
        is_first[1:] &= is_gap[:-1]
        is_odd = (is_first & ((characters < ord('0')) | (characters > ord('9')))) | (
            characters == ord(COMMENT))
        counts: Positions = np.add.reduceat(is_first, firsts, dtype=np.intp)
        counts[np.logical_or.reduceat(is_odd, firsts)] = 0
        return counts

    def tags(self, elements: Positions) -> list[str]:
        """
        Return start tags.

        :param elements: indices of elements.
        :return: all that is written between ``<`` and ``>``.
        """
        return self._cut(self._begins[elements] + 1, self._ends[elements])

    def lines(self, elements: Positions) -> npt.NDArray[np.int32]:
        """
        Tell which lines elements stand in.

        :param elements: their indices.
        :return: the line in which the start tag of each ends, the first one being 1.
        """
        lines = np.searchsorted(self._newlines, self._ends[elements]) + 1
        if len(self.starts) > 1:
            texts = np.searchsorted(self.starts, self._begins[elements], side='right') - 1
            lines -= self._newlines_before[texts]
        elif self._newlines_between:
            lines += self._newlines_between * (
                self._begins[elements] >= self._all_tags.part.start)
        return lines.astype(np.int32)

    def first_values(self, elements: Positions) -> list[str]:
        """
        Return the names of elements where they are written as mostly: first, in double quotes.

        :param elements: indices of elements.
        :return: value of the attribute ``name``, as it is written; empty where it is written in
            another way, or there is none.
        """
        return self._cut(*self._places_of_value(self._places_of_name(elements), b'name'))

    def second_values(self, elements: Positions, attribute: bytes) -> tuple[list[str], _Flags]:
        """
        Return an attribute where it comes second and last, behind the name.

        :param elements: indices of elements.
        :param attribute: its name; empty for none.
        :return: its value for each, as it is written; empty where there is only a name; and
            whether there may be anything else.
        """
        ends = self._content_ends(elements)
        _, name_ends = self._places_of_value(self._places_of_name(elements), b'name')
        is_only_name = name_ends + 1 == ends
        if is_only_name.all():
            return [''] * len(elements), ~is_only_name
        begins, value_ends = self._places_of_value(name_ends, attribute)
        is_plain = is_only_name | (value_ends + 1 == ends)
        return self._cut(begins, value_ends), ~is_plain

    def _text_ends(self, elements: Positions) -> Positions:
        """Return where the first run of character data in elements ends."""
        tags, first_tags = self._all_tags, self._tags[elements]
        # What follows is another tag, that of a child or of the end; in an empty element nothing.
        following = tags.begins.take(first_tags + 1, mode='clip')
        is_empty = tags.is_empty[first_tags]
        ends: Positions = np.where(is_empty, self._ends[elements] + 1, following)
        return ends

    def _content_ends(self, elements: Positions) -> Positions:
        """Return where what is written in the start tags of elements ends."""
        ends: Positions = self._ends[elements] - self._all_tags.is_empty[self._tags[elements]]
        return ends

    def _places_of_name(self, elements: Positions) -> Positions:
        """Return the last character of each tag's own name."""
        ends: Positions = self._begins[elements] + _NAME_LENGTHS[self.numbers[elements]] - 1
        return ends

    def _places_of_value(
        self, before: Positions, attribute: bytes,
    ) -> tuple[Positions, Positions]:
        """Return where a value begins and ends of which the attribute follows; else 0 and 0."""
        written = b' %b="' % attribute
        begins = before + 1
        is_there = before > 0
        for start in range(0, len(written), WIDTH):
            part = written[start:start + WIDTH]
            words = self._words[np.minimum(begins + start, len(self._words) - 1)]
            mask = np.uint64((1 << 8 * len(part)) - 1)
            is_there &= words & mask == np.uint64(int.from_bytes(part, 'little'))
        begins = begins + len(written)
        ends = self._quotes[np.searchsorted(self._quotes[:-1], begins)]
        return np.where(is_there, begins, 0), np.where(is_there, ends, 0)

    def has_attributes(self, elements: Positions) -> npt.NDArray[np.bool_]:
        """
        Tell which elements may have attributes.

        :param elements: their indices.
        :return: false for those whose tag has nothing but its name.
        """
        lengths = _NAME_LENGTHS[self.numbers[elements]]
        is_longer: _Flags = self._begins[elements] + lengths < self._content_ends(elements)
        return is_longer

    def holders(self, elements: Positions) -> Positions:
        """
        Find what holds elements.

        :param elements: their indices.
        :return: the index of the element around each; -1 where that has another tag.
        """
        order, borders = self._by_depth, self._depth_borders
        index_of = np.full(len(self._depths), -1, dtype=np.intp)
        index_of[self._ordinals] = np.arange(len(self._ordinals))
        ordinals = self._ordinals[elements]
        depths = self._depths[ordinals]
        result = np.full(len(elements), -1, dtype=np.intp)
        for depth in (np.flatnonzero(np.bincount(depths)[1:]) + 1).tolist():
            here = np.flatnonzero(depths == depth)
            # The last element before, of those one level further out, is the holder.
            outer = order[borders[depth - 1]:borders[depth]]
            result[here] = index_of[outer[np.searchsorted(outer, ordinals[here]) - 1]]
        return result

    def _cut(self, begins: Positions, ends: Positions) -> list[str]:
        text = self._all_tags.text
        cut: list[str] = []
        # Some at a time, so that memory is used again while it is still near to the processor.
        for start in range(0, len(begins), _PIECES):
            pieces = [text[begin:end] for begin, end in zip(
                begins[start:start + _PIECES].tolist(), ends[start:start + _PIECES].tolist(),
                strict=True)]
            # To decode one long text is quicker than many short ones; XML has no zero bytes.
            cut += b'\0'.join(pieces).decode().split('\0')
        return cut


def markup_from_texts(texts: Sequence[bytes]) -> Markup | None:
    """
    Find the elements of texts.

    :param texts: well-formed XML, in UTF-8.
    :return: the elements; None where :func:`~sdf_pose_bridge.tag_search.tags_from_texts` finds
        something else.
    """
    tags = tags_from_texts(texts)
    return None if tags is None else Markup(tags)
