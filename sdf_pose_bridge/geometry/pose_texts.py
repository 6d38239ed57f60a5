# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read poses and rotations as people type them, or paste what a program has printed.

Numbers may be in lists and in several lines. A form is a text that names the order or the units of
its numbers, by keys, by an element or by its structure, so that it has one format only.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from decimal import Decimal
import re
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.geometry.formats import (
    Format,
    POSE_FORMATS,
    PoseFormatError,
    ROTATION_FORMATS,
)
from sdf_pose_bridge.names import shortened

FORMATS: Mapping[str, Format] = {**ROTATION_FORMATS, **POSE_FORMATS}
"""All formats of numbers."""

_SEPARATOR = re.compile(r'[\s,;()\[\]{}]+')
_SEPARATOR_OF_NAMES = re.compile(r"""(?:[\s,;:=()\[\]{}<>/"']|-(?=\s))+""")
_ARRAY = re.compile(r'\b(?:\w+\.)?(?:array|matrix|tensor)\(|,\s*dtype=[\w.]+')
_DECIMAL_COMMA = re.compile(r'(?<![\w.,+-])[-+]?\d+,\d+(?![\w.]|,\S)')
_COMMA, _BLANK = re.compile(r'\d,\s*[-+.\d]'), re.compile(r'[\d.][ \t]+[-+.\d]')
_NUMBERS = re.compile(r'[\s\d.,;eE+\[\]-]+')
_NAME = re.compile(r'\s*(?:- |At time\b|\w+:(?:\s|$))')
_NUMBER_OR_LIST = re.compile(r'[-+.]?\d|[\[({<]|--\w')

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


class Form(NamedTuple):
    """A text that names the format of its numbers."""

    text: str
    """The text, for people."""
    format: Format
    pattern: str
    """A regular expression, whose group is the part with the numbers."""
    parts: tuple[tuple[str, str], ...]
    """
    Names and numbers (#) in the order of the format, and numbers instead if they are missing.

    Words are separated by blanks, whatever separates them in the text.
    """
    name: str = ''
    """Name for users of a form that is also printed."""
    template: str = ''
    """The printed text, with places for the numbers."""


def typed_pose_from_text(
    text: str, source: Format | None = None, default: Format | None = None, form_name: str = '',
) -> TypedPose:
    """
    Read the numbers of one pose or rotation.

    :param text: numbers, with commas, semicolons and brackets if there are any, or a form.
    :param source: the requested format; a text that names another one is refused.
    :param default: the format of numbers if neither the text nor ``source`` says it.
    :param form_name: the name of the only forms that are read; empty for all, and for numbers.
    :raises NoFormatError: if nothing says the format.
    :raises PoseFormatError: if the text is no pose in the format, or has decimal commas.
    """
    text, begun = text.replace(_MINUS, '-'), None
    if _DECIMAL_COMMA.search(text):
        raise _decimal_commas(text)
    for form in () if _NUMBERS.fullmatch(text) and '[[' not in text else FORMS:
        found = re.search(form.pattern, text, re.DOTALL)
        if found is None or form_name not in ('', form.name):
            continue
        begun = form
        if words := _words_of_form(form, found[1]):
            if source is not None and source.name != form.format.name:
                msg = f'the text is {form.format.name} ({form.text}), not {source.name}'
                raise PoseFormatError(msg)
            return _typed_pose(
                words, [*map(number_from_text, words)], form.format,
                f'read as {form.format.name}: {form.text}')
    if begun is not None or form_name:
        msg = f'the text has not the numbers of {begun.text if begun else form_name}'
        raise PoseFormatError(msg)
    text, source = _ARRAY.sub(' ', text), source or default
    words = [*filter(None, _SEPARATOR.split(text))]
    numbers = [*map(number_from_text, words)]
    if _COMMA.search(text) and _BLANK.search(text):
        raise _decimal_commas(text)
    if source is None:
        msg = f'nothing says the format of these {len(numbers)} numbers'
        raise NoFormatError(msg)
    if len(words) == 12 and source.last_row == (12, 13, 14, 15):
        return _typed_pose(
            words, [*numbers, 0.0, 0.0, 0.0, 1.0], source, 'the last row 0 0 0 1 is added')
    if len(words) != source.row_length:
        hint = '; decimals need points' if ',' in text and '.' not in text else ''
        msg = (f'{source.name} has {source.row_length} numbers ({source.meaning}), but'
               f' {len(words)} {"is" if len(words) == 1 else "are"} given{hint}')
        raise PoseFormatError(msg)
    return _typed_pose(words, numbers, source)


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


def texts_from_lines(lines: Iterable[str], row_length: int) -> Iterator[tuple[int, str]]:
    """
    Divide lines into texts, each of one pose or rotation.

    Most texts are one line. A list, an element, the rows of a matrix, and names with numbers take
    several. Blank lines, and lines that begin with #, are between texts.

    :param row_length: how many numbers a line with a whole pose has.
    :return: the number of the first line, and the text.
    """
    first, text = 0, ''
    for number, line in enumerate(lines, start=1):
        is_blank = line.strip() in ('', '---')
        if text and (is_blank or (_NAME.match(text) and (
                _NUMBER_OR_LIST.match(line) or line.split()[0] == text.split()[0] != '-'))
                or _row_count(text) not in (0, _row_count(line))):
            yield first, text
            text = ''
        if not text and (is_blank or line.lstrip().startswith('#')):
            continue
        first, text = (first, text + line) if text else (number, line)
        count, rows = _row_count(text), text.count('\n')
        is_open = sum(map(text.count, '[({')) > sum(map(text.count, '])}'))
        is_row = count not in (0, row_length) and rows < count and rows * count != row_length
        if not (is_open or is_row or _NAME.match(text) or ('<' in text and '/' not in text)):
            yield first, text
            text = ''
    if text:
        yield first, text


def _row_count(text: str) -> int:
    """Return how many numbers the first line of a text has if it may be one of a matrix; or 0."""
    count = len(_SEPARATOR.sub(' ', text.partition('\n')[0]).split())
    return count if count in (3, 4) and _NUMBERS.fullmatch(text) else 0


def _typed_pose(
    words: list[str], numbers: list[float], source: Format, *notes: str,
) -> TypedPose:
    """Return a pose; of a matrix whose digits are few, with the nearest rotation."""
    places = list(source.columns)
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


def _words_of_form(form: Form, body: str) -> list[str]:
    """Return the numbers of a text in the order of the format; none if they are others."""
    rest = ' '.join(filter(None, _SEPARATOR_OF_NAMES.split(body)))
    words: list[str] = []
    for part, missing in form.parts:
        pattern = rf'(?<!\S){part.replace("#", "([-+.0-9][^ ]*)")}(?! [-+.]?\d|\S)'
        found = [match.groups() for match in re.finditer(pattern, rest)]
        if len(found) > 1:
            msg = f'the text has several poses ({form.text}); give one at a time'
            raise PoseFormatError(msg)
        if not found and not missing:
            return []
        words += found[0] if found else missing.split()
        rest = re.sub(pattern, '', rest) if missing else rest
    # A misspelt name must not become a missing one.
    is_complete = not form.parts[0][1] or not re.search(r'(?<!\S)[-+.]?\d', rest)
    return words if is_complete else []


def _decimal_commas(text: str) -> PoseFormatError:
    return PoseFormatError(
        f'"{shortened(" ".join(text.split()), 40)}" has decimal commas, or commas between some'
        ' numbers only; decimals need points')


# The table

def _list(count: int) -> str:
    return r'\[' + ','.join(count * [r'[^][,]+']) + r'\]\s*'


def _options(names: str, missing: str) -> tuple[tuple[str, str], ...]:
    return tuple((f'--{name} #', default) for name, default in zip(
        names.split(), missing.split(), strict=True))


_RPY, _RPY_DEGREES, _QUAT = (
    POSE_FORMATS[name] for name in ('sdf_rpy', 'sdf_rpy_degrees', 'sdf_quat_xyzw'))
_SIX, _SEVEN = (((f'^{" ".join(count * "#")}$', ''),) for count in (6, 7))

FORMS = (
    Form('<pose>', _QUAT, r"""<pose\b[^<>]*rotation_format=["']quat_xyzw[^<>]*>([^<]*)""",
         _SEVEN, 'sdf_pose'),
    Form('<pose degrees="true">', _RPY_DEGREES,
         r"""<pose\b[^<>]*degrees=["'](?:true|1)\b[^<>]*>([^<]*)""", _SIX, 'sdf_pose'),
    Form('<pose>', _RPY, r'<pose\b[^<>]*>([^<]*)', _SIX, 'sdf_pose',
         '<pose>{} {} {} {} {} {}</pose>'),
    Form('<origin>', _RPY, r'<origin\b([^<>]*)', (('xyz # # #', '0 0 0'), ('rpy # # #', '0 0 0')),
         'urdf_origin', '<origin xyz="{} {} {}" rpy="{} {} {}"/>'),
    Form('static_transform_publisher', _QUAT, r'\A(?=.*--q[xyzw]\b)(.*)',
         _options('x y z qx qy qz qw', '0 0 0 0 0 0 1'), 'static_transform_publisher',
         '--x {} --y {} --z {} --qx {} --qy {} --qz {} --qw {}'),
    Form('static_transform_publisher', _RPY, r'\A(?=.*--(?:[xyz]|roll|pitch|yaw)\b)(.*)',
         _options('x y z roll pitch yaw', '0 0 0 0 0 0'), 'static_transform_publisher'),
    Form('p[...] of Universal Robots', POSE_FORMATS['ur_pose'], r'\bp\[([^][]*)\]', _SIX),
    Form('{X ...} of KUKA', POSE_FORMATS['kuka_abc'], r'\{(?:\s*\w+\s*:)?(\s*X\b[^{}]*)',
         (('X # Y # Z # A # B # C #', ''),)),
    Form('robtarget of ABB', POSE_FORMATS['abb'],
         rf'\[\s*({_list(3)},\s*{_list(4)}),\s*{_list(4)},\s*{_list(6)}\]', _SEVEN),
    Form('a message of ROS', _QUAT, r'((?:position|translation|Point|Vector3)\b.*)', (
        (r'(?:position|translation|\S*Point|\S*Vector3) x # y # z #', ''),
        (r'(?:orientation|rotation|\S*Quaternion) x # y # z # w #', ''))),
    Form('tf2_echo', _QUAT, r'(Translation\b.*)', (
        ('Translation # # #', ''), (r'in Quaternion(?: \D\S*)? # # # #', ''))),
    Form('easy_handeye', _QUAT._replace(position=(4, 5, 6), columns=(1, 2, 3, 0)),
         r'transformation:(.*)', (('qw # qx # qy # qz # x # y # z #', ''),)),
    Form('a quaternion of ROS', ROTATION_FORMATS['quaternion'], r'\A(\s*\{?\s*x:.*\bw:.*)',
         (('x # y # z # w #', ''),)),
)
"""The forms; the first one that has the numbers of a text counts."""

TEXT_FORMATS = {form.name: form for form in FORMS if form.template}
"""The forms that are printed."""

NAMES_OF_ARGUMENTS = (
    *dict.fromkeys(part.split()[0] for form in FORMS for part, _ in form.parts if part[0] == '-'),
    '--frame-id', '--child-frame-id')
"""The arguments of static_transform_publisher."""
