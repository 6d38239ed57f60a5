# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read and check values as libsdformat does (``Param.cc``), by the types of the grammar.

No pose depends on a friction coefficient. But Gazebo does not load a file with a wrong one, so
such a file is refused here too.

Texts of ``<pose>`` become x y z and a unit quaternion (http://sdformat.org/spec, ``pose.sdf``:
``rotation_format``, ``degrees``). Of the numbers that C's ``strtod`` takes, a pose may have only
decimal ones here: no ``0x10``, no ``1.5abc``. Quaternions are normalised, which libsdformat does
not do.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
import math
import re
import sys
from typing import NamedTuple
from typing import TYPE_CHECKING

import numpy as np

from sdf_pose_bridge.geometry.rotations import quaternion_from_rpy
from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.sdformat.grammar import Definition
from sdf_pose_bridge.sdformat.grammar import ValueType
from sdf_pose_bridge.sdformat.xml_tree import first_child
from sdf_pose_bridge.sdformat.xml_tree import text_of
from sdf_pose_bridge.sdformat.xml_tree import WHITE_SPACE
from sdf_pose_bridge.sdformat.xml_tree import XmlElement

if TYPE_CHECKING:
    import numpy.typing as npt


# Like C's strtod, libsdformat takes the number at the beginning of a word and drops the rest.
_LEADING_NUMBER = re.compile(
    r'[+-]?(?:[0-9]+\.?[0-9]*(?:[eE][+-]?[0-9]+)?|\.[0-9]+(?:[eE][+-]?[0-9]+)?|inf|nan)',
    re.IGNORECASE)
_LEADING_INTEGER_OR_BOOLEAN = re.compile(r'[+-]?[0-9]|true|false', re.IGNORECASE)
_LEADING_BOOLEAN = re.compile(r'true|false', re.IGNORECASE)
_DIGITS = frozenset('0123456789')
_SHORTEST_AXIS = 1e-6
_LONGEST_PLAIN = 200
"""A number with fewer characters, and without an exponent, is in the range of a double."""
_NOT_ZERO = re.compile(r'[^eE]*[1-9]')
_FEWEST_COLOR_NUMBERS = 3
# Python takes longer to look up a member of an Enum than a global variable.
_AXIS, _BOOLEAN, _COLOR = ValueType.AXIS, ValueType.BOOLEAN, ValueType.COLOR
_FRAME, _INTEGER, _NUMBER = ValueType.FRAME, ValueType.INTEGER, ValueType.NUMBER


def boolean_from_text(text: str) -> bool | None:
    """
    Read a boolean.

    :param text: the value, with or without white space around it.
    :return: the boolean; None if the text is not ``true``, ``false``, ``1`` or ``0`` in any case.
    """
    value = text.strip(WHITE_SPACE).lower()
    if value in ('true', '1'):
        return True
    if value in ('false', '0'):
        return False
    return None


def value_fault(text: str, definition: Definition) -> str:
    """
    Return what is wrong with the value of an element.

    :param text: the value. If the element is not required, the default replaces a blank one.
    :param definition: the definition of the element; not that of a pose.
    :return: the value and the rule that it breaks; empty if it is right.
    """
    if (definition.takes_any_number and text[:1] in _DIGITS and len(text) < _LONGEST_PLAIN
            and 'e' not in text and 'E' not in text):
        return ''
    value_type = definition.value_type
    stripped = text.strip(WHITE_SPACE)
    if not stripped and definition.is_required and value_type is not None:
        return f'<{definition.identifier}> is empty; it must have a value'
    if not stripped or value_type is None or definition.is_text:
        return ''
    numbers = leading_numbers(stripped, value_type.count)
    if not _is_of_type(stripped, numbers, value_type):
        return f'"{stripped[:80]}" is not {value_type.description}'
    if value_type is _AXIS and math.hypot(*numbers) <= _SHORTEST_AXIS:
        return f'"{stripped}" is not a valid axis: its length is zero'
    minimum, maximum = definition.minimum, definition.maximum
    # Like libsdformat, this accepts what is not a number.
    if not numbers or not (numbers[0] < minimum or numbers[0] > maximum):
        return ''
    rule = f'at least {minimum:g}' if maximum == math.inf else f'from {minimum:g} to {maximum:g}'
    return f'"{stripped}" must be {rule}'


def is_representable(text: str, number: float) -> bool:
    """
    Return whether C's ``strtod`` reads a number without a range error.

    :param text: the number as written, such as ``1e-3`` or ``inf``.
    :param number: the number as a double.
    :return: False for numbers such as ``1e400`` and ``1e-400``.
    """
    if number == 0.0:
        return not _NOT_ZERO.match(text)
    if math.isinf(number):
        return text.lstrip('+-')[:1] in 'iI'
    return math.isnan(number) or abs(number) >= sys.float_info.min


def is_of_type(text: str, value_type: ValueType) -> bool:
    """
    Return whether libsdformat takes a text as a value of a type.

    :param text: the value, stripped and not empty.
    :param value_type: any type but ``POSE``.
    :return: True if it does.
    """
    return _is_of_type(text, leading_numbers(text, value_type.count), value_type)


def _is_of_type(text: str, numbers: Sequence[float], value_type: ValueType) -> bool:
    if value_type is _COLOR:
        return len(numbers) == len(text.split()) >= _FEWEST_COLOR_NUMBERS and all(
            not (number < 0.0 or number > 1.0) for number in numbers)
    if value_type is _NUMBER:
        return (bool(numbers) and is_representable(text, numbers[0])) or (
            _LEADING_BOOLEAN.match(text) is not None)
    if value_type is _INTEGER:
        return _LEADING_INTEGER_OR_BOOLEAN.match(text) is not None
    if value_type is _BOOLEAN:
        return boolean_from_text(text) is not None
    if value_type is _FRAME:
        return text != ROOT_FRAME
    return len(numbers) == value_type.count  # 0 for a text


def leading_numbers(text: str, count: int) -> Sequence[float]:
    """
    Return the numbers that the first words of a text begin with.

    :param text: the value of an element.
    :param count: how many words are read.
    :return: the numbers; none for a word that begins with none.
    """
    words = text.split()[:count]
    # Python also reads 1_000 and the digits of all scripts.
    if '_' not in text and text.isascii():
        try:
            return [float(word) for word in words]
        except ValueError:
            pass
    matches = map(_LEADING_NUMBER.match, words)
    return [float(number[0]) for number in matches if number]


def numbers_of_child(
    parent: XmlElement, tag: str, default: tuple[float, ...],
) -> tuple[float, ...]:
    """
    Return the numbers in a child element.

    :param parent: an element.
    :param tag: tag of the child.
    :param default: the numbers if there is no child, or if it has fewer numbers than these.
    :return: as many numbers as there are in the default.
    """
    child = first_child(parent, tag)
    numbers = () if child is None else tuple(leading_numbers(text_of(child), len(default)))
    return numbers if len(numbers) == len(default) else default


# Poses

SHORTEST_QUATERNION = 1e-9
"""A quaternion with a smaller norm has no meaningful direction."""

_LARGEST_NORM = 1e150
"""The squares of larger norms are beyond the range of a double."""

_NORM_TOLERANCE = 1e-3
"""A quaternion whose norm differs more from 1 is probably not what was meant."""

_LARGEST_ANGLE_RAD = 6.3
"""A larger angle, of more than a turn, was probably meant in degrees."""

_IDENTITY_TEXTS = {6: '0 0 0 0 0 0', 7: '0 0 0 0 0 0 1'}
_DECIMAL_NUMBER = re.compile(r'[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?')
_NUMBER_CHARACTERS = b'0123456789+-.eE \t\n\r'
_THREE_DIGIT_EXPONENT = re.compile(r'[eE]-0*[1-9][0-9][0-9]')


class PoseFormat(NamedTuple):
    """How the numbers of a pose are to be read."""

    is_quaternion: bool = False
    """True for ``rotation_format="quat_xyzw"``, False for ``euler_rpy``."""
    is_degrees: bool = False
    """Whether roll, pitch and yaw are in degrees."""

    @property
    def layout(self) -> str:
        """The names of the numbers in their order."""
        return 'x y z qx qy qz qw' if self.is_quaternion else 'x y z roll pitch yaw'


class PoseTextError(ValueError):
    """The text is not a pose; the message has the value and the rule."""


class PosesFromTexts(NamedTuple):
    """Result of :func:`poses_from_texts`."""

    poses: npt.NDArray[np.float64]
    """Shape (n, 7): x y z in metres, unit quaternion x y z w; the identity for each failure."""
    failures: list[tuple[int, str]]
    """The index of each text that is not a pose, and the reason."""
    doubts: list[tuple[int, str]]
    """The index of each text that may mean another pose, and the reason."""


def poses_from_texts(texts: Sequence[str], pose_format: PoseFormat) -> PosesFromTexts:
    """
    Convert many texts.

    :param texts: n poses as written; a blank text is the identity.
    :param pose_format: the format of all of them.
    :return: the poses.
    """
    failures: list[tuple[int, str]] = []
    numbers = _numbers_from_texts(texts, len(pose_format.layout.split()))
    if numbers is None:
        rows = []
        for index, text in enumerate(texts):
            try:
                rows.append(_numbers_from_text(text, pose_format))
            except PoseTextError as error:
                failures.append((index, str(error)))
                rows.append(_numbers_from_text('', pose_format))
        numbers = np.array(rows)
    doubts = [
        (row, _doubt(texts[row], pose_format)) for row in _doubtful_rows(numbers, pose_format)]
    return PosesFromTexts(_poses_from_numbers(numbers, pose_format), failures, doubts)


def pose_from_text(text: str, pose_format: PoseFormat) -> Sequence[float]:
    """
    Convert one text.

    :param text: a pose as written; a blank text is the identity.
    :param pose_format: its format.
    :return: x y z in metres, unit quaternion x y z w.
    :raises PoseTextError: if it is not a pose.
    """
    numbers = np.array([_numbers_from_text(text, pose_format)])
    pose: list[float] = _poses_from_numbers(numbers, pose_format)[0].tolist()
    return pose


def _numbers_from_text(text: str, pose_format: PoseFormat) -> list[float]:
    """Read the numbers of a text; those of a quaternion that is too large are scaled."""
    layout = pose_format.layout
    count = len(layout.split())
    words = _words(text) or _IDENTITY_TEXTS[count].split()
    shown = _shown(text)
    for word in words:
        if not _DECIMAL_NUMBER.fullmatch(word):
            msg = f'"{word[:80]}" in the pose "{shown}" is not a finite decimal number'
            raise PoseTextError(msg)
        if not is_representable(word, float(word)):
            msg = f'"{word[:80]}" in the pose "{shown}" is beyond the range of a double'
            raise PoseTextError(msg)
    if len(words) != count:
        msg = f'a pose has {count} values ({layout}), "{shown}" has {len(words)}'
        raise PoseTextError(msg)
    numbers = [float(word) for word in words]
    if pose_format.is_quaternion:
        norm = math.hypot(*numbers[3:])
        if norm < SHORTEST_QUATERNION:
            msg = f'the quaternion of the pose "{shown}" is zero, so it is not a rotation'
            raise PoseTextError(msg)
        if math.isinf(norm):
            msg = f'the quaternion of the pose "{shown}" is beyond the range of a double'
            raise PoseTextError(msg)
        if norm > _LARGEST_NORM:
            numbers[3:] = [number / norm for number in numbers[3:]]
    return numbers


def _words(text: str) -> list[str]:
    stripped = text.strip(WHITE_SPACE)
    return re.split(f'[{WHITE_SPACE}]+', stripped) if stripped else []


def _shown(text: str) -> str:
    shown = ' '.join(_words(text))
    return shown if len(shown) <= 80 else shown[:77] + '...'


def _doubtful_rows(numbers: npt.NDArray[np.float64], pose_format: PoseFormat) -> list[int]:
    if pose_format.is_quaternion:
        is_doubtful = np.abs(np.linalg.norm(numbers[:, 3:], axis=1) - 1.0) > _NORM_TOLERANCE
    elif pose_format.is_degrees:
        return []
    else:
        is_doubtful = np.abs(numbers[:, 3:]).max(axis=1, initial=0.0) > _LARGEST_ANGLE_RAD
    rows: list[int] = np.flatnonzero(is_doubtful).tolist()
    return rows


def _doubt(text: str, pose_format: PoseFormat) -> str:
    if pose_format.is_quaternion:
        return f'the quaternion of the pose "{_shown(text)}" is not of length 1; it is normalised'
    return f'the angles of the pose "{_shown(text)}" are radians; did you mean degrees="true"?'


def _numbers_from_texts(texts: Sequence[str], count: int) -> npt.NDArray[np.float64] | None:
    """
    Read the numbers of many texts at once, which takes a tenth of the time.

    :param texts: n texts.
    :param count: how many numbers each should have.
    :return: shape (n, count); None if any text needs a closer look.
    """
    texts = [text or _IDENTITY_TEXTS[count] for text in texts]
    joined = ' '.join(texts)
    words = [text.split() for text in texts]
    if (not joined.isascii() or joined.encode().translate(None, _NUMBER_CHARACTERS)
            or _THREE_DIGIT_EXPONENT.search(joined)
            or max(map(len, texts), default=0) >= _LONGEST_PLAIN
            or any(len(each) != count for each in words)):
        return None
    try:
        numbers = np.fromiter(
            map(float, chain.from_iterable(words)), np.float64, len(words) * count)
    except ValueError:
        return None
    numbers = numbers.reshape(-1, count)
    is_quaternion = count == 7
    if np.abs(numbers).max(initial=0.0) > (_LARGEST_NORM if is_quaternion else sys.float_info.max):
        return None
    if is_quaternion and (np.linalg.norm(numbers[:, 3:], axis=1) < SHORTEST_QUATERNION).any():
        return None
    return numbers


def _poses_from_numbers(
    numbers: npt.NDArray[np.float64], pose_format: PoseFormat,
) -> npt.NDArray[np.float64]:
    poses = np.empty((len(numbers), 7))
    poses[:, :3] = numbers[:, :3]
    rotations = numbers[:, 3:]
    if pose_format.is_quaternion:
        norms = np.sqrt(np.einsum('ij,ij->i', rotations, rotations))
        poses[:, 3:] = rotations / norms[:, np.newaxis]
    else:
        rpy_rad = np.radians(rotations) if pose_format.is_degrees else rotations
        poses[:, 3:] = quaternion_from_rpy(rpy_rad)
    return poses
