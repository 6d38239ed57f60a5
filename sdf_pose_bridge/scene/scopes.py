# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Look up the frames that references name: siblings and downwards, never upwards."""

from __future__ import annotations

from collections.abc import Iterator
from collections.abc import Sequence

import numpy as np

from sdf_pose_bridge.errors import hint_from_names
from sdf_pose_bridge.names import FRAME_KINDS
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.names import MODEL_FRAME
from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.names import scoped_name
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.names import WORLD_FRAME
from sdf_pose_bridge.sdformat.elements import Elements
from sdf_pose_bridge.sdformat.elements import NOWHERE

_OWN_FRAME = SEPARATOR + MODEL_FRAME
_MOST_NAMES_COMPARED = 2000

IS_FRAME_KIND = np.zeros(len(Kind), dtype=bool)
IS_FRAME_KIND[list(FRAME_KINDS)] = True
IS_FRAME_KIND.setflags(write=False)
"""For each kind whether others may refer to elements of it."""


class Scopes:
    """
    The absolute names of all elements, and the frames that they name.

    :param table: the elements.

    ``names[i]`` is the absolute name of element i, such as ``robot::arm::hand``: the names of the
    models that hold it and its own, without the world's. ``roots[i]`` is the index of the world
    or implicit root that it belongs to; each of these has names of its own.
    """

    def __init__(self, table: Elements) -> None:
        self._table = table
        self._missing = table.missing
        self.names = _absolute_names(table)
        self.roots = _roots(table)
        self._is_model: list[bool] = (table.kinds == Kind.MODEL).tolist()
        self._frames: dict[int, dict[str, int]] = {}
        frames = np.flatnonzero(IS_FRAME_KIND[table.kinds])
        roots = np.array(self.roots, dtype=np.intp)
        for root in np.flatnonzero(table.parents < 0).tolist():
            indices = frames[roots[frames] == root][::-1].tolist()
            # Of equal names, which are errors, the first one counts.
            names = map(self.names.__getitem__, indices)
            self._frames[root] = dict(zip(names, indices, strict=True))

    def frame(self, scope: int, reference: str) -> int | None:
        """
        Find the frame that a reference means.

        :param scope: index of the model, world or root in which it is written.
        :param reference: the name as written, not empty.
        :return: index of the frame, or None if there is none of that name.
        """
        if self._is_model[scope]:
            if reference == MODEL_FRAME:
                return scope
            name = scoped_name(self.names[scope], reference)
        else:
            if reference == WORLD_FRAME and self._table.kinds[scope] == Kind.WORLD:
                return scope
            name = reference
        frames = self._frames[self.roots[scope]]
        found = frames.get(name)
        if found is None and name.endswith(_OWN_FRAME):
            found = frames.get(name[:-len(_OWN_FRAME)])
            if found is not None and not self._is_model[found]:
                return None
        return found

    def frames(self, scopes: Sequence[int], references: Sequence[str]) -> list[int | None]:
        """
        Find the frames that many references mean.

        :param scopes: for each the model, world or root in which it is written.
        :param references: the names as written, not empty.
        :return: as :meth:`frame` does for each.
        """
        is_model, names, roots = self._is_model, self.names, self.roots
        frames = [
            scope if reference == MODEL_FRAME and is_model[scope] else
            self._frames[roots[scope]].get(
                f'{names[scope]}{SEPARATOR}{reference}' if is_model[scope] else reference)
            for scope, reference in zip(scopes, references, strict=True)]
        if None in frames:  # the few names that mean a scope itself, and those that mean nothing
            for place, found in enumerate(frames):
                if found is None:
                    frames[place] = self.frame(scopes[place], references[place])
        return frames

    def missing_uri(self, scope: int, reference: str) -> str:
        """
        Tell whether a reference means something that could not be included.

        :param scope: index of the model, world or root in which it is written.
        :param reference: the name as written.
        :return: the URI of the include; empty if it is none of those.
        """
        if not self._missing:
            return ''
        steps = reference.split(SEPARATOR)
        for count in range(len(steps)):
            outer = self.frame(scope, SEPARATOR.join(steps[:count])) if count else scope
            names = self._missing.get(NOWHERE if outer is None else outer, {})
            uri = names.get(steps[count]) or names.get('')
            if uri:
                return uri
        return ''

    def described(self, scope: int) -> str:
        """
        Name a scope for a sentence.

        :param scope: index of a model, world or root.
        :return: such as ``model "robot::arm"``.
        """
        kind = self._table.kind(scope)
        if kind is Kind.ROOT:
            return 'the top of the file'
        name = self._table.names[scope] if kind is Kind.WORLD else self.names[scope]
        return f'{kind.label} "{name}"'

    def hint(self, scope: int, reference: str) -> str:
        """
        Return the end of a sentence about a reference that means nothing.

        :param scope: index of the model, world or root in which it is written.
        :param reference: the name as written.
        :return: the reason or the nearest name there is, or an empty string.
        """
        first = reference.split(SEPARATOR)[0]
        if self._is_model[scope]:
            if first == self._table.names[scope]:
                rest = reference[len(first) + len(SEPARATOR):]
                return (f'; inside a model its own name is not visible, write '
                        f'"{rest or MODEL_FRAME}"')
            outer = int(self._table.parents[scope])
            while outer >= 0:
                if self.frame(outer, reference) is not None:
                    return (f'; {self.described(outer)} has a frame of that name, but names of '
                            'enclosing scopes cannot be used')
                outer = int(self._table.parents[outer])
        return hint_from_names(reference, self._visible_names(scope))

    def _visible_names(self, scope: int) -> Iterator[str]:
        is_model = self._is_model[scope]
        prefix = self.names[scope] + SEPARATOR if is_model else ''
        yield MODEL_FRAME if is_model else WORLD_FRAME
        count = 0
        for name in self._frames[self.roots[scope]]:
            if name.startswith(prefix):
                yield name[len(prefix):]
                count += 1
                if count == _MOST_NAMES_COMPARED:
                    return


def _absolute_names(table: Elements) -> list[str]:
    parents: list[int] = table.parents.tolist()
    names = list(table.names)
    prefixes = dict.fromkeys(np.flatnonzero(table.parents < 0).tolist(), '')
    for index in prefixes:
        names[index] = WORLD_FRAME if table.kinds[index] == Kind.WORLD else ROOT_FRAME
    is_top = table.parents < 0
    holds = np.zeros(len(names), dtype=bool)
    holds[table.parents[~is_top]] = True
    # Holders come before what they hold.
    for index in np.flatnonzero(holds & ~is_top).tolist():
        name = names[index] = prefixes[parents[index]] + names[index]
        prefixes[index] = name + SEPARATOR
    for index in np.flatnonzero(~holds & ~is_top).tolist():
        names[index] = prefixes[parents[index]] + names[index]
    return names


def _roots(table: Elements) -> list[int]:
    tops = np.flatnonzero(table.parents < 0)
    # Elements stand in file order, so each belongs to the top before it.
    counts = np.diff(np.append(tops, len(table.names)))
    return np.repeat(tops, counts).tolist()  # type: ignore[no-any-return]
