# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Take what is regular out of a text, so that only the rest of it has to be made into a tree."""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Sequence
import itertools
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.element_rows import Columns
from sdf_pose_bridge.element_rows import RowTree
from sdf_pose_bridge.markup import Markup
from sdf_pose_bridge.markup import Spans
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.plain_values import doubtful_elements
from sdf_pose_bridge.row_extraction import columns_from_markup
from sdf_pose_bridge.tag_search import Positions
from sdf_pose_bridge.versions import Version

_MANY_LINES = 1_000_000

_HOLDS_RUNS = np.zeros(256, dtype=bool)
_HOLDS_RUNS[[Kind.WORLD, Kind.MODEL]] = True
_HOLDS_RUNS.setflags(write=False)


class Remainder(NamedTuple):
    """What is left of a text without its regular part, and what is known of the whole text."""

    text: bytes
    """What is left, with every element in the line in which it was."""
    kept: Positions
    """The elements that are left, in ascending order."""
    doubtful: Mapping[str, Positions]
    """For each tag the elements of which the values have to be looked at one by one; all of them
    are left."""
    rows: RowTree
    """All elements that carry a pose, of this text and maybe of others."""
    first_row: int
    """The first of them that is of this text."""


def remainders_from_markup(
    markup: Markup, texts: Sequence[bytes], version: Version,
) -> list[Remainder]:
    """
    Take what is regular out of texts.

    :param markup: the elements of the texts, without any ``<include>``.
    :param texts: the texts.
    :param version: the version by whose rules all of them are written.
    :return: what is left of each: all that does not carry a pose nor is held by something that
        does, whatever has to be looked at one by one, and what holds these.
    """
    columns = columns_from_markup(markup, markup.lines, version)
    doubtful = doubtful_elements(markup)
    spans = markup.spans(columns.elements[_removable_rows(columns)])
    spans = _spans_without(spans, markup.begins[np.concatenate(
        [np.zeros(0, dtype=np.intp), *doubtful.values()])])
    begins, ends = _joined(spans)
    places = np.searchsorted(begins, markup.begins, side='right') - 1
    kept = np.flatnonzero(markup.begins >= np.append(ends, 0)[places])
    left = _texts_without(markup, texts, begins, ends)
    rows = RowTree(columns)
    first_rows = np.searchsorted(columns.elements, markup.roots).tolist()
    if len(texts) == 1:
        return [Remainder(left[0], kept, doubtful, rows, first_rows[0])]
    all_kept = np.split(kept, np.searchsorted(kept, markup.roots[1:]))
    all_doubtful = _doubtful_of_texts(markup, doubtful)
    return [
        Remainder(text, kept, doubtful, rows, first_row)
        for text, kept, doubtful, first_row in zip(
            left, all_kept, all_doubtful, first_rows, strict=True)]


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


def _texts_without(
    markup: Markup, texts: Sequence[bytes], begins: Positions, ends: Positions,
) -> list[bytes]:
    """Take parts out of texts, but leave the lines that they go over."""
    newlines = markup.newlines_between(begins, ends).tolist()
    firsts = [*np.searchsorted(begins, markup.starts).tolist(), len(begins)]
    left = []
    for text, start, (first, last) in zip(
            texts, markup.starts.tolist(), itertools.pairwise(firsts), strict=True):
        borders = np.stack((begins[first:last], ends[first:last]), axis=1).ravel() - start
        pieces = [text[begin:end] for begin, end in zip(
            [0, *borders[1::2].tolist()], [*borders[0::2].tolist(), len(text)], strict=True)]
        left.append(b''.join(itertools.chain.from_iterable(
            (piece, _empty_lines(count))
            for piece, count in zip(pieces, [*newlines[first:last], 0], strict=True))))
    return left


def _empty_lines(count: int) -> bytes:
    """Write line ends, with comments between them where a parser would find them too many."""
    whole, rest = divmod(count, _MANY_LINES)
    return whole * (b'\n' * _MANY_LINES + b'<!---->') + b'\n' * rest


def _doubtful_of_texts(
    markup: Markup, doubtful: Mapping[str, Positions],
) -> list[dict[str, Positions]]:
    found: list[dict[str, Positions]] = [{} for _ in markup.roots]
    for tag, elements in doubtful.items():
        borders = np.searchsorted(elements, markup.roots[1:])
        for of_text, part in zip(found, np.split(elements, borders), strict=True):
            if len(part):
                of_text[tag] = part
    return found
