# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Take what is regular out of a text, so that only the rest of it has to be made into a tree."""

from __future__ import annotations

from collections.abc import Mapping
import itertools
from typing import NamedTuple
from typing import TYPE_CHECKING

import numpy as np

from sdf_pose_bridge.element_rows import Columns
from sdf_pose_bridge.markup import Markup
from sdf_pose_bridge.markup import Positions
from sdf_pose_bridge.markup import Spans
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.plain_values import doubtful_elements
from sdf_pose_bridge.row_extraction import columns_from_markup
from sdf_pose_bridge.versions import Version

if TYPE_CHECKING:
    import numpy.typing as npt

_HOLDS_RUNS = np.zeros(256, dtype=bool)
_HOLDS_RUNS[[Kind.WORLD, Kind.MODEL]] = True
_HOLDS_RUNS.setflags(write=False)


class Remainder(NamedTuple):
    """What is left of a text without its regular part, and what is known of that."""

    text: bytes
    """What is left, with every element in the line in which it was."""
    is_kept: npt.NDArray[np.bool_]
    """Which elements are left."""
    columns: Columns
    """What is known of all elements that carry a pose."""
    doubtful: Mapping[str, Positions]
    """For each tag the elements of which the values have to be looked at one by one; all of them
    are left."""


def remainder_from_markup(markup: Markup, version: Version) -> Remainder:
    """
    Take what is regular out of a text.

    :param markup: the elements of the text, without any ``<include>``.
    :param version: the version by whose rules it is written.
    :return: what is left: all that does not carry a pose nor is held by something that does,
        whatever has to be looked at one by one, and what holds these.
    """
    columns = columns_from_markup(markup, markup.lines, version)
    doubtful = doubtful_elements(markup)
    spans = markup.spans(columns.elements[_removable_rows(columns)])
    spans = _spans_without(spans, markup.begins[np.concatenate(
        [np.zeros(0, dtype=np.intp), *doubtful.values()])])
    begins, ends = _joined(spans)
    places = np.searchsorted(begins, markup.begins, side='right') - 1
    is_kept = markup.begins >= np.append(ends, 0)[places]
    return Remainder(_without(markup, begins, ends), is_kept, columns, doubtful)


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


def _without(markup: Markup, begins: Positions, ends: Positions) -> bytes:
    newlines = markup.newlines_between(begins, ends).tolist()
    borders = [0, *np.stack((begins, ends), axis=1).ravel().tolist(), len(markup.text)]
    pieces = [markup.text[begin:end] for begin, end in zip(
        borders[0::2], borders[1::2], strict=True)]
    return b''.join(itertools.chain.from_iterable(
        (piece, b'\n' * count) for piece, count in zip(pieces, [*newlines, 0], strict=True)))
