# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read poses and rotations as people type them, or paste what a program has printed.

Numbers alone may be in lists and in several lines. In other texts, names say what the numbers are:
tables have the names of each format.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from decimal import Decimal
import re
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.geometry.formats import (
    Format,
    format_from_name,
    POSE_FORMATS,
    PoseFormatError,
    ROTATION_FORMATS,
)
from sdf_pose_bridge.geometry.pose_search import FoundPose, poses_from_text
from sdf_pose_bridge.printed_text import shortened

FORMATS: Mapping[str, Format] = {**ROTATION_FORMATS, **POSE_FORMATS}
"""All formats of numbers."""

_LONGEST_TEXT = 1_000_000
"""The most characters of a text."""

_SEPARATOR = re.compile(r'[\s,;()\[\]{}]+')
_ARRAY = re.compile(r'\b(?:\w+\.)?(?:array|matrix|tensor)\(|,\s*dtype=[\w.]+')
_DECIMAL_COMMA = re.compile(r'(?<![\w.,+-])[-+]?\d+,\d+(?![\w.]|,\S)')
_COMMA, _BLANK = re.compile(r'\d,\s*[-+.\d]'), re.compile(r'[\d.][ \t]+[-+.\d]')
_FIRST_NUMBER = re.compile(r'[\s\[({]*[-+.]?\d|\s*\Z')

_NUMBERS = re.compile(r'[\s\d.,;eE+\[\]-]+')
_NAME = re.compile(
    r'\s*(?:- |At time\b|["\']?\w+["\']?:(?:\s|$)|[\w.]+\s*=\s*[-+.\d]|\w+\s*\{\s*$|<[?!])')
_FIRST_OF_TEXT = re.compile(r'[-+.]?\d|[\[({<]|--\w|\w+ ?[\[(]')
_BEGIN, _END = re.compile('<[A-Za-z]|<!--'), re.compile('</|/>|-->')

_MINUS = '\u2212'
_FEWEST_DIGITS, _EXACT = 2, 1e-6
"""A matrix with fewer digits, or nearer to a rotation, is not changed."""


class NoFormatError(PoseFormatError):
    """Nothing says the format of numbers."""


class TypedPose(NamedTuple):
    """A pose or rotation that was typed or pasted."""

    numbers: list[float]
    """As many as in a row of the format; they may be not finite."""
    format: Format
    notes: tuple[str, ...] = ()
    """Clauses for people: how the text was read."""
    name: str = ''
    """The name of the pose in a list of poses, if it has one."""


class TextFormat(NamedTuple):
    """A text that is printed as a format."""

    format: Format
    text: str
    """The text of a pose that is found in it."""
    template: str
    """The text, with places for the numbers."""


def only_pose(poses: Sequence[TypedPose]) -> TypedPose:
    """Return the pose of a text; raise a PoseFormatError if it has several."""
    if len(poses) > 1:
        msg = f'the text has several poses ({len(poses)}); give one at a time'
        raise PoseFormatError(msg)
    return poses[0]


def typed_poses_from_text(
    text: str, source: Format | None = None, default: Format | None = None, form_name: str = '',
) -> Sequence[TypedPose]:
    """
    Read a pose or rotation, or a list of poses with names.

    :param text: numbers, with commas, semicolons and brackets if there are any, or with names.
    :param source: the requested format; a text that names another one is refused.
    :param default: the format of numbers if neither the text nor ``source`` says it.
    :param form_name: the name in :data:`TEXT_FORMATS` of the only text that is read; or empty.
    :raises NoFormatError: if nothing says the format.
    :raises PoseFormatError: if the text is no pose in the format, or has decimal commas.
    """
    text = text.replace(_MINUS, '-')
    if len(text) > _LONGEST_TEXT:
        msg = f'the text has more than {_LONGEST_TEXT} characters'
        raise PoseFormatError(msg)
    without_names = _ARRAY.sub(' ', text)
    is_numbers = _FIRST_NUMBER.match(without_names) is not None
    found: Sequence[FoundPose] = ()
    if form_name or not is_numbers or '[[' in text:
        found = poses_from_text(text, source)
        if found and '\n' not in text.strip() and (comment := re.search(r'\s#.*\d', text)):
            msg = f'"{shortened(comment[0])}" may hide numbers; give the lines as they are'
            raise PoseFormatError(msg)
    if form_name and {TEXT_FORMATS[form_name].text} != {each.text for each in found}:
        msg = f'the text is no {form_name}'
        raise PoseFormatError(msg)
    if found and source is not None and found[0].format.name != source.name:
        msg = f'the text is {found[0].format.name} ({found[0].text}), not {source.name}'
        raise PoseFormatError(msg)
    if found:
        return [_typed_pose(words, read, *(what and (f'read as {read.name}: {what}',)), *notes)
                ._replace(name=name) for words, read, what, _, notes, name in found]
    if _DECIMAL_COMMA.search(text):
        raise _decimal_commas(text)
    if not is_numbers and re.search('[:=<{]', text):
        msg = (f'"{shortened(" ".join(text[:200].split()), 40)}" has no names of a pose, such as'
               ' x y z roll pitch yaw; docs/pose_formats.md lists them')
        raise PoseFormatError(msg)
    words, source = [*filter(None, _SEPARATOR.split(without_names))], source or default
    numbers = [*map(number_from_text, words)]
    if _COMMA.search(text) and _BLANK.search(text):
        raise _decimal_commas(text)
    if source is None:
        msg = f'nothing says the format of these {len(numbers)} numbers'
        raise NoFormatError(msg)
    notes: tuple[str, ...] = ()
    if source.name not in FORMATS:  # a sequence of axes
        if len(words) == 3:
            source = format_from_name(source.name, ROTATION_FORMATS)._replace(angle=source.angle)
        notes = (f'read as {source.name}: {source.meaning}',)
    elif len(words) == 12 and source.last_row[:1] == (12,):
        source, notes = source._replace(last_row=()), ('the last row 0 0 0 1 is added',)
    if len(words) != source.row_length:
        hint = '; decimals need points' if ',' in text and '.' not in text else ''
        msg = (f'{source.name} has {source.row_length} numbers ({source.meaning}), but'
               f' {len(words)} {"is" if len(words) == 1 else "are"} given{hint}')
        raise PoseFormatError(msg)
    return [_typed_pose(words, source, *notes)]


def number_from_text(text: str) -> float:
    """Read one number; raise a PoseFormatError for another text."""
    word = text.replace(_MINUS, '-')
    try:
        if '_' in word or not word.isascii():
            # float() accepts 1_000 and digits of all scripts; other readers of poses do not.
            raise ValueError
        return float(word)
    except ValueError:
        msg = f'{shortened(text)!r} is not a number'
        raise PoseFormatError(msg) from None


class TextDivider:
    """
    Divides lines into rows of numbers and texts, each of a pose or rotation, or of a list.

    A line with as many numbers as the format has is a row. Brackets, elements, the rows of a
    matrix, and names with numbers take several lines. Lines that begin with # belong to no text.

    :param source: the format; None if the texts name theirs.
    """

    def __init__(self, source: Format | None) -> None:
        self._source = source
        # A line of a sequence of axes has a pose or a rotation.
        self._is_sequence = source is not None and source.name not in FORMATS
        self._length = 0 if source is None or self._is_sequence else source.row_length
        self._number, self._is_after_blank = 0, False
        self._lines: list[str] = []
        """Those of a text that is not complete."""
        self._parts: list[tuple[int, int]] = []
        """The numbers, and places among these, of lines before which there are blank ones."""
        self._depth, self._size, self._row_count, self._is_named, self._takes_rows = (
            0, 0, 0, False, False)
        self._texts: list[tuple[int, str | list[float]]] = []

    def divided(
        self, lines: Iterable[str], *, is_end: bool = False,
    ) -> Sequence[tuple[int, str | list[float]]]:
        """
        Return what is complete after some more lines.

        :param is_end: whether there are no more, so that all is complete.
        :return: with the number of its first line, each text, or the numbers of a row.
        """
        self._texts = []
        for line in lines:
            self._number += 1
            words = line.split()
            if words and len(words) == self._length and not (
                    self._lines and self._is_in_text(line)) and (row := self._row(words, line)):
                self._end()
                self._texts.append((self._number, row))
            elif not words or words[0] in ('---', '...'):
                self._is_after_blank = True
                if words or not (self._is_named or self._depth):
                    self._end()
            elif words[0][0] not in '#%':
                self._add(line, words)
        if is_end:
            self._end()
        return self._texts

    def _row(self, words: Sequence[str], line: str) -> list[float] | None:
        """Return the numbers of a line; None if they are none, or those of a rounded matrix."""
        try:
            row = [*map(float, words)]
        except ValueError:
            return None
        columns = self._source.columns if self._source else ()
        is_plain = line.isascii() and '_' not in line and (
            len(columns) != 9 or _is_exact([row[column] for column in columns]))
        return row if is_plain else None

    def _is_pose(self, text: tuple[int, str]) -> bool:
        try:
            return bool(typed_poses_from_text(text[1], self._source))
        except PoseFormatError:
            return False

    def _is_in_text(self, line: str) -> bool:
        """Whether a line is in the brackets, or the rows, of the text before."""
        return line[0].isspace() or self._lines[-1].rstrip()[-1:] == '\\' or (
            not self._is_after_blank and (self._depth > 0 or (
                self._takes_rows and _FIRST_OF_TEXT.match(line) is not None)))

    def _add(self, line: str, words: Sequence[str]) -> None:
        is_row = _NUMBERS.fullmatch(line) is not None
        if self._lines and self._depth == 0 and (
                not is_row or len(words) != self._row_count if self._row_count else
                not self._is_in_text(line) and (
                    (words[0] == self._lines[0].split()[0] != '-' and (
                        words[1:] != ['{'] or self._is_after_blank)) or (
                        _FIRST_OF_TEXT.match(line) and self._lines[0][:2] not in ('<?', '<!')))):
            self._end()
        if not self._lines:
            self._parts, self._is_named = [(self._number, 0)], _NAME.match(line) is not None
            self._depth, self._size, self._takes_rows = 0, 0, False
            self._row_count = len(words) if is_row and len(words) in (3, 4) and (
                not self._is_sequence) else 0
        if self._is_after_blank and self._lines and not line[0].isspace():
            self._parts.append((self._number, len(self._lines)))
        self._lines.append(line)
        self._size += len(line)
        text = line.partition(' #')[0]
        self._depth = max(0, self._depth + sum(map(text.count, '[({')) - sum(
            map(text.count, '])}')))
        if self._lines[0].lstrip()[0] == '<':
            self._depth = max(0, self._depth + len(_BEGIN.findall(text)) - len(_END.findall(text)))
        self._is_after_blank = False
        self._takes_rows = text.rstrip()[-1:] == ':' or (
            self._takes_rows and is_row and not line[0].isspace())
        is_partial = len(self._lines) < self._row_count and (
            len(self._lines) * self._row_count != self._length)
        if self._size > _LONGEST_TEXT or not (
                self._depth or self._is_named or is_partial or text.rstrip()[-1:] == '\\'):
            self._end()

    def _end(self) -> None:
        if self._lines:
            ends = [*(begin for _, begin in self._parts[1:]), len(self._lines)]
            parts = [(number, ''.join(self._lines[begin:end]))
                     for (number, begin), end in zip(self._parts, ends, strict=True)]
            whole = self._parts[0][0], ''.join(self._lines)
            # A file with blank lines, unless these are between poses.
            are_texts = parts[1:] and not self._is_pose(whole) and any(map(self._is_pose, parts))
            self._texts += parts if are_texts else [whole]
        self._lines = []


def _is_exact(matrix: Sequence[float]) -> bool:
    """Whether the rows of a 3 x 3 matrix are orthonormal, so that it is not rounded."""
    a, b, c, d, e, f, g, h, i = matrix
    return max(
        abs(a * a + b * b + c * c - 1.0), abs(d * d + e * e + f * f - 1.0),
        abs(g * g + h * h + i * i - 1.0), abs(a * d + b * e + c * f),
        abs(a * g + b * h + c * i), abs(d * g + e * h + f * i)) < 1e-7


def _typed_pose(words: Sequence[str], source: Format, *notes: str) -> TypedPose:
    """Return a pose; of a matrix whose digits are few, with the nearest rotation."""
    numbers, places = [*map(number_from_text, words)], list(source.columns)
    if len(places) == 9 and np.abs(matrix := np.array(numbers)[places]).max() < 2.0:
        # Small numbers have more digits behind the point in some programs.
        digits = max((-int(Decimal(words[place]).as_tuple().exponent) for place in places
                      if abs(numbers[place]) >= 0.1), default=0)
        before, _, after = np.linalg.svd(matrix.reshape(3, 3))
        rotation = (before @ after).ravel()
        distance = np.linalg.norm(rotation - matrix)
        # Each of nine elements differs by half a unit of its last digit at most.
        if digits >= _FEWEST_DIGITS and _EXACT < distance <= 1.5 * 10.0 ** -digits:
            notes += (f'the matrix has {digits} digits; the nearest rotation is used',)
            for place, element in zip(places, rotation.tolist(), strict=True):
                numbers[place] = element
    return TypedPose(numbers, source, notes)


def _decimal_commas(text: str) -> PoseFormatError:
    return PoseFormatError(
        f'"{shortened(" ".join(text.split()), 40)}" has decimal commas, or commas between some'
        ' numbers only; decimals need points')


TEXT_FORMATS = {
    'sdf_pose': TextFormat(POSE_FORMATS['sdf_rpy'], '<pose>', '<pose>{} {} {} {} {} {}</pose>'),
    'urdf_origin': TextFormat(
        POSE_FORMATS['sdf_rpy'], '<origin>', '<origin xyz="{} {} {}" rpy="{} {} {}"/>'),
    'static_transform_publisher': TextFormat(
        POSE_FORMATS['sdf_quat_xyzw'], 'static_transform_publisher',
        '--x {} --y {} --z {} --qx {} --qy {} --qz {} --qw {}')}
"""The texts that are printed."""

NAMES_OF_ARGUMENTS = tuple(f'--{name}' for name in (
    *'x y z qx qy qz qw roll pitch yaw frame-id child-frame-id'.split(),))
"""The arguments of static_transform_publisher."""
