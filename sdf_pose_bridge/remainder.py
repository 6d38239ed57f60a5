# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Take what is regular out of a text, so that only the rest of it has to be made into a tree."""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Sequence
import itertools
from typing import NamedTuple
from typing import TYPE_CHECKING

import numpy as np

from sdf_pose_bridge.element_rows import Columns
from sdf_pose_bridge.element_rows import RowTree
from sdf_pose_bridge.markup import Markup
from sdf_pose_bridge.markup import Spans
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.plain_values import doubtful_elements
from sdf_pose_bridge.row_extraction import columns_from_markup
from sdf_pose_bridge.tag_search import parts_from_tags
from sdf_pose_bridge.tag_search import Positions
from sdf_pose_bridge.tag_search import Tags
from sdf_pose_bridge.versions import Version

if TYPE_CHECKING:
    import numpy.typing as npt

_MANY_LINES = 10_000

_HOLDS_RUNS = np.zeros(256, dtype=bool)
_HOLDS_RUNS[[Kind.WORLD, Kind.MODEL]] = True
_HOLDS_RUNS.setflags(write=False)


class Remainder(NamedTuple):
    """What is left of a text without its regular part, and what is known of the whole text."""

    text: bytes
    """What is left, with every element in the line in which it was."""
    kept: Positions
    """The elements that are left, in ascending order."""
    numbers: npt.NDArray[np.int16]
    """The tag of each of these, as a number of the known tags."""
    doubtful: Mapping[str, Positions]
    """For each tag the elements of which the values have to be looked at one by one; all of them
    are left."""
    rows: Sequence[RowTree]
    """All elements that carry a pose, part by part; maybe also those of other texts."""
    first_row: int
    """The first of them that is of this text."""


class _Part(NamedTuple):
    """What is found in a part of a text, or in several texts."""

    begins: Positions
    """Where what is taken out begins."""
    ends: Positions
    newlines: Positions
    """How many lines each piece that is taken out goes over."""
    kept: Positions
    numbers: npt.NDArray[np.int16]
    doubtful: Mapping[str, Positions]
    columns: Columns
    roots: Positions


def remainders_from_tags(
    tags: Tags, texts: Sequence[bytes], version: Version, part_size: int,
) -> list[Remainder] | None:
    """
    Take what is regular out of texts.

    :param tags: the tags of the texts.
    :param texts: the texts.
    :param version: the version by whose rules all of them are written.
    :param part_size: about how many bytes of a long text to look at at a time.
    :return: what is left of each: all that does not carry a pose nor is held by something that
        does, whatever has to be looked at one by one, and what holds these. None if there is an
        ``<include>``, or an outermost element that is no ``<sdf>``.
    """
    parts: list[_Part] = []
    count = 0
    for some_tags in parts_from_tags(tags, part_size):
        markup = Markup(some_tags)
        if len(markup.of('include')) or not np.array_equal(markup.roots, markup.of('sdf')):
            return None
        parts.append(_part_from_markup(markup, version, count))
        count += len(markup.numbers)
    if len(parts) > 1 and not _are_apart([part.columns for part in parts]):
        return remainders_from_tags(tags, texts, version, len(tags.text))
    kept = np.concatenate([part.kept for part in parts])
    numbers = np.concatenate([part.numbers for part in parts])
    rows = [RowTree(part.columns) for part in parts]
    roots = parts[0].roots
    borders = np.searchsorted(kept, roots[1:])
    return [
        Remainder(text, kept, numbers, doubtful, rows, first_row)
        for text, kept, numbers, doubtful, first_row in zip(
            _texts_without(tags, texts, parts), np.split(kept, borders),
            np.split(numbers, borders),
            _doubtful_of_texts([part.doubtful for part in parts], roots),
            np.searchsorted(parts[0].columns.elements, roots).tolist(), strict=True)]


def _part_from_markup(markup: Markup, version: Version, first_element: int) -> _Part:
    columns = columns_from_markup(markup, markup.lines, version)
    doubtful = doubtful_elements(markup)
    spans = markup.spans(columns.elements[_removable_rows(columns)])
    spans = _spans_without(spans, markup.begins[np.concatenate(
        [np.zeros(0, dtype=np.intp), *doubtful.values()])])
    begins, ends = _joined(spans)
    places = np.searchsorted(begins, markup.begins, side='right') - 1
    kept = np.flatnonzero(markup.begins >= np.append(ends, 0)[places])
    kept = kept[markup.are_in_part(kept)]
    return _Part(
        begins, ends, markup.newlines_between(begins, ends), kept + first_element,
        markup.numbers[kept],
        {tag: elements[markup.are_in_part(elements)] + first_element
         for tag, elements in doubtful.items()},
        columns._replace(elements=columns.elements + first_element), markup.roots)


def _are_apart(parts: Sequence[Columns]) -> bool:
    """
    Tell whether what one element holds can be looked at part by part.

    :param parts: the rows of each part, of which the first is the element itself.
    :return: false if some name needs a closer look, or is that of several elements.
    """
    keys = []
    for columns in parts:
        if not len(columns.names) or not _HOLDS_RUNS[columns.kinds[0]]:
            return False
        rows = np.flatnonzero(columns.parents == 0)
        if columns.has_odd_name[rows].any():
            return False
        names = map(columns.names.__getitem__, rows.tolist())
        keys.append(np.fromiter(map(hash, names), np.int64, len(rows)))
    in_order = np.sort(np.concatenate(keys))
    return not (in_order[1:] == in_order[:-1]).any()


def _removable_rows(columns: Columns) -> Positions:
    """
    Return rows that are regular with all that they hold, none of which holds another.

    Only what a model or world holds is read without looking at the tree; and not even that where
    some name has to be looked at, for it may turn out to be that of a regular element.
    """
    parents = columns.parents
    holds_odd = columns.is_odd.copy()
    rows = np.flatnonzero(columns.is_odd)
    while len(rows):
        rows = parents[rows].astype(np.intp)
        rows = rows[rows >= 0]
        rows = rows[~holds_odd[rows]]
        holds_odd[rows] = True
    holds_runs = _HOLDS_RUNS[columns.kinds]
    holders = parents[columns.has_odd_name]
    holds_runs[holders[holders >= 0]] = False
    # The last entry serves what stands at the top.
    is_removable = ~holds_odd & np.append(holds_runs, False)[parents]
    return np.flatnonzero(is_removable & ~np.append(is_removable, False)[parents])


def _spans_without(spans: Spans, places: Positions) -> Spans:
    """Leave out spans in which any of some places lies."""
    if not len(places) or not len(spans.begins):
        return spans
    around = np.searchsorted(spans.begins, places, side='right') - 1
    is_inside = (around >= 0) & (places < spans.ends[around])
    is_left = np.ones(len(spans.begins), dtype=bool)
    is_left[around[is_inside]] = False
    return Spans(*(column[is_left] for column in spans))


def _joined(spans: Spans) -> tuple[Positions, Positions]:
    """Join spans between which there is no tag; return where they begin and end."""
    begins, ends, first_tags, last_tags = spans
    has_gap = first_tags[1:] > last_tags[:-1] + 1
    return begins[np.append(True, has_gap)[:len(begins)]], ends[np.append(has_gap, True)[
        :len(ends)]]


def _texts_without(tags: Tags, texts: Sequence[bytes], parts: Sequence[_Part]) -> list[bytes]:
    """Take pieces out of texts, but leave the lines that they go over."""
    begins = np.concatenate([part.begins for part in parts])
    ends = np.concatenate([part.ends for part in parts])
    counts = [count for part in parts for count in part.newlines.tolist()]
    firsts = [*np.searchsorted(begins, tags.starts).tolist(), len(begins)]
    left = []
    for text, start, (first, last) in zip(
            texts, tags.starts.tolist(), itertools.pairwise(firsts), strict=True):
        borders = np.stack((begins[first:last], ends[first:last]), axis=1).ravel() - start
        pieces = [text[begin:end] for begin, end in zip(
            [0, *borders[1::2].tolist()], [*borders[0::2].tolist(), len(text)], strict=True)]
        left.append(b''.join(itertools.chain.from_iterable(
            (piece, _empty_lines(count))
            for piece, count in zip(pieces, [*counts[first:last], 0], strict=True))))
    return left


def _empty_lines(count: int) -> bytes:
    """Write line ends, with comments between them where a parser would find them too many."""
    whole, rest = divmod(count, _MANY_LINES)
    return whole * (b'\n' * _MANY_LINES + b'<!---->') + b'\n' * rest


def _doubtful_of_texts(
    parts: Sequence[Mapping[str, Positions]], roots: Positions,
) -> list[dict[str, Positions]]:
    found: list[dict[str, Positions]] = [{} for _ in roots]
    for tag in dict.fromkeys(tag for part in parts for tag in part):
        elements = np.concatenate([part[tag] for part in parts if tag in part])
        borders = np.searchsorted(elements, roots[1:])
        for of_text, of_tag in zip(found, np.split(elements, borders), strict=True):
            if len(of_tag):
                of_text[tag] = of_tag
    return found
