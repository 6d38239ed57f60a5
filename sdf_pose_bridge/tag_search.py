# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Find all tags of well-formed texts, in one or in many files at a time."""

from __future__ import annotations

from collections.abc import Iterator
from collections.abc import Sequence
import itertools
import re
from typing import Any
from typing import NamedTuple
from typing import TYPE_CHECKING
from typing import TypeAlias

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

Positions: TypeAlias = 'npt.NDArray[np.intp]'
_Flags: TypeAlias = 'npt.NDArray[np.bool_]'

COMMENT = '\x01'
"""Stands for each character of a comment in the texts of elements."""

_COMMENT = re.compile(rb'<!--.*?(?:-->|\Z)', re.DOTALL)
_BLANKED = bytes(byte if byte == ord('\n') else ord(COMMENT) for byte in range(256))
_DECLARATION = re.compile(rb'<\?xml[^>]*>')

_BLANK = b' \t\n\r' + COMMENT.encode()

_BLOCK = 1 << 18


class Tags(NamedTuple):
    """All tags of some texts, in their order."""

    text: bytes
    """The texts one after the other, without declarations, and with :data:`COMMENT` in the place
    of each character of a comment."""
    starts: Positions
    """Where each of the texts begins."""
    roots: Positions
    """Which of the tags each text begins with."""
    begins: Positions
    """Where each ``<`` stands."""
    ends: Positions
    """Where each ``>`` stands."""
    is_closing: _Flags
    is_empty: _Flags
    """Whether each is start and end in one."""
    depths: npt.NDArray[np.int16]
    """How many elements are open before each."""
    part: slice
    """The part of the text in which these tags stand, but for those around the part."""
    newlines_before: int = 0
    """How many line ends there are before the part."""

    @property
    def deepest(self) -> int:
        """How many elements stand around the one that stands deepest."""
        return int(self.depths.max())

    @property
    def longest_text(self) -> int:
        """Length of the longest run of characters between two tags, in bytes."""
        return int((self.begins[1:] - self.ends[:-1]).max(initial=0))


class _Brackets(NamedTuple):
    begins: Positions
    ends: Positions
    is_closing: _Flags
    is_empty: _Flags


def tags_from_texts(texts: Sequence[bytes]) -> Tags | None:
    """
    Find all tags.

    :param texts: well-formed XML, in UTF-8.
    :return: the tags; None if there is more in brackets than tags and comments, a bracket by
        itself, or anything behind an outermost element.
    """
    text = _joined(texts)
    starts = np.cumsum([0, *map(len, texts[:-1])])
    found = _brackets_from_text(text)
    if found is None:
        return None
    begins, ends, is_closing, is_empty = found
    steps = np.where(is_closing, np.int32(-1), np.int32(1))
    steps[is_empty] = 0
    depths = np.cumsum(steps, dtype=np.int32) - steps
    roots = np.flatnonzero(depths < 1)
    if len(roots) != len(texts) or depths[-1] > 1 or (
            np.searchsorted(starts, begins[roots], side='right') - 1 != np.arange(len(texts))
            ).any():
        return None
    tags = Tags(
        text, starts, roots, begins, ends, is_closing, is_empty, depths.astype(np.int16),
        slice(0, len(text)))
    return None if _have_tails(tags) else tags


def parts_from_tags(tags: Tags, size: int) -> Iterator[Tags]:
    """
    Divide the tags of a long text, so that what is made of a part stays near to the processor.

    :param tags: all tags of some texts.
    :param size: about how many bytes of the text a part has.
    :return: the parts, each with the tags of the outermost element and of the only one in it
        around what that holds; all tags where there are several such elements.
    """
    inner = np.flatnonzero((tags.depths == 1) & ~tags.is_closing)
    last = len(tags.begins) - 2
    if len(tags.starts) > 1 or len(tags.text) < 2 * size or len(inner) != 1 or (
            inner[0] != 1 or tags.is_empty[1]):
        yield tags
        return
    held = np.flatnonzero((tags.depths == 2) & ~tags.is_closing)
    chosen = np.searchsorted(tags.begins[held], np.arange(size, len(tags.text), size))
    borders = [2, *dict.fromkeys(held[chosen[chosen < len(held)]].tolist()), last]
    buffer = np.frombuffer(tags.text, np.uint8)
    newlines = 0
    for first, end in itertools.pairwise(borders):
        if first == end:
            continue
        begin = 0 if first == 2 else int(tags.begins[first])
        part = slice(begin, len(tags.text) if end == last else int(tags.begins[end]))
        rows = slice(2), slice(first, end), slice(last, None)
        yield tags._replace(
            begins=_chosen(tags.begins, rows), ends=_chosen(tags.ends, rows),
            is_closing=_chosen(tags.is_closing, rows), is_empty=_chosen(tags.is_empty, rows),
            depths=_chosen(tags.depths, rows), part=part, newlines_before=newlines)
        newlines += int(np.count_nonzero(buffer[part] == ord('\n')))


def _chosen(values: Any, rows: Sequence[slice]) -> Any:
    return np.concatenate([values[some] for some in rows])


def _brackets_from_text(text: bytes) -> _Brackets | None:
    """Find brackets; None if they enclose anything but tags, or do not stand in pairs."""
    buffer = np.frombuffer(text, np.uint8)
    blocks = []
    start = text.find(b'<', 1 if text.startswith(b'<?') else 0)
    if start < 0:
        return None
    while start < len(text):
        # Block by block, so that what is worked with stays near to the processor.
        end = text.find(b'<', start + _BLOCK)
        end = len(text) if end < 0 else end
        block = _brackets(buffer[start:end])
        if block is None:
            return None
        begins, ends, is_closing, is_empty = block
        blocks.append(_Brackets(begins + start, ends + start, is_closing, is_empty))
        start = end
    return _Brackets(*map(np.concatenate, zip(*blocks, strict=True)))


def _brackets(buffer: npt.NDArray[np.uint8]) -> _Brackets | None:
    bits = np.uint8(ord('<') ^ ord('>'))
    brackets = np.flatnonzero((buffer | bits) == np.uint8(ord('>')))
    begins, ends = brackets[0::2], brackets[1::2]
    if len(begins) != len(ends) or (
            (buffer[begins] != ord('<')).any() or (buffer[ends] != ord('>')).any()):
        return None
    kinds = buffer[begins + 1]
    if (kinds == ord('!')).any() or (kinds == ord('?')).any():
        return None
    return _Brackets(begins, ends, kinds == ord('/'), buffer[ends - 1] == ord('/'))


def places(buffer: npt.NDArray[np.uint8], character: str) -> Positions:
    """
    Find a character; block by block, so that what lies between stays in the processor.

    :param buffer: where to look.
    :param character: what to look for.
    :return: the places.
    """
    byte = np.uint8(ord(character))
    blocks = [
        np.flatnonzero(buffer[start:start + _BLOCK] == byte) + start
        for start in range(0, max(len(buffer), 1), _BLOCK)]
    return np.concatenate(blocks)


def _joined(texts: Sequence[bytes]) -> bytes:
    """Join texts; replace comments, which may hold anything, and declarations but the first."""
    text = texts[0] if len(texts) == 1 else b''.join(map(_without_declaration, texts))
    if text.find(b'!') < 0:
        return text
    return _COMMENT.sub(lambda comment: comment.group().translate(_BLANKED), text)


def _without_declaration(text: bytes) -> bytes:
    declaration = _DECLARATION.match(text)
    if declaration is None:
        return text
    length = declaration.end()
    return declaration.group().translate(_BLANKED) + text[length:]


def _have_tails(tags: Tags) -> bool:
    """
    Tell whether anything follows the outermost element of any text.

    The parser says so too, but not of a text that holds a prefix which is not declared.
    """
    last_tags = [*(tags.roots[1:] - 1).tolist(), len(tags.begins) - 1]
    ends = [*tags.starts[1:].tolist(), len(tags.text)]
    return any(
        tags.text[begin + 1:end].strip(_BLANK)
        for begin, end in zip(tags.ends[last_tags].tolist(), ends, strict=True))
