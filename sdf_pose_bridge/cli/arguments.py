# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Arguments that several commands have."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Collection, Sequence
import contextlib
import os
from pathlib import Path
from typing import Any

from sdf_pose_bridge.geometry.units import DEGREES, METRES, MILLIMETRES, RADIANS
from sdf_pose_bridge.nearest_names import hint_from_names
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.tree import DEFAULT_KINDS, TfOptions

SHOWN_KINDS = tuple(kind for kind in Kind if kind not in (Kind.ROOT, Kind.WORLD))
"""The kinds that ``--kinds`` accepts."""

_SHOWN_BY_NAME = {kind.label: kind for kind in SHOWN_KINDS}
_KIND_NAMES = ', '.join(_SHOWN_BY_NAME)
_FORMATS = {
    'text': 'for people, the default',
    'csv': 'comma-separated values with a header, in metres and radians',
    'json': 'one object per file and line, in metres and radians',
    'github': 'annotations that GitHub shows in a review',
}


def argument_type(
    convert: Callable[[str], Any], rule: str, is_valid: Callable[[Any], bool] = lambda _: True,
) -> Callable[[str], Any]:
    """
    Return a type of an argument.

    :param convert: returns the value of a text; may raise a ValueError.
    :param rule: the end of the message about another text, behind the text.
    :param is_valid: whether a value is valid.
    """
    def value_from_text(text: str) -> Any:
        with contextlib.suppress(ValueError):
            value = convert(text)
            if is_valid(value):
                return value
        msg = f'"{text}" {rule}'
        raise argparse.ArgumentTypeError(msg)
    return value_from_text


def add_unit_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments ``--degrees``, the default, ``--radians`` and ``--mm``."""
    angles = parser.add_mutually_exclusive_group()
    for unit in (DEGREES, RADIANS):
        angles.add_argument(
            f'--{unit.text}', dest='angle_unit', action='store_const', const=unit, default=DEGREES,
            help=f'angles in {unit.text}{", the default" if unit == DEGREES else ""}')
    parser.add_argument(
        '--mm', dest='length_unit', action='store_const', const=MILLIMETRES, default=METRES,
        help='lengths in millimetres, not metres')


def add_digits_argument(parser: argparse.ArgumentParser) -> None:
    """Add the argument ``--digits`` of tables of poses."""
    parser.add_argument(
        '--digits', metavar='N', type=argument_type(
            int, 'must be a number from 0 to 15', lambda count: 0 <= count <= 15),
        help='print N digits behind the point; by default those that the smallest length needs, '
             'if the table is not wider than 80 columns')


def add_format_argument(parser: argparse.ArgumentParser, *formats: str) -> None:
    """Add the argument ``--format`` with formats besides ``text``."""
    choices = ('text', *formats)
    meanings = ', '.join(f'{name}: {_FORMATS[name]}' for name in choices)
    parser.add_argument(
        '--format', choices=choices, default='text', help=f'output format: {meanings}')


def add_output_argument(
    parser: argparse.ArgumentParser, formats: Sequence[str], what: str,
) -> None:
    """Add the argument ``-o``, a path whose ending, such as ``.svg``, is one of some or any."""
    parser.add_argument(
        '-o', dest='output', metavar='PATH', help=f'where to write {what}', type=argument_type(
            Path, f'must end with one of {", ".join(formats)}',
            lambda path: not formats or path.suffix.lower() in formats))


def add_file_arguments(parser: argparse.ArgumentParser, *, takes_many: bool = True) -> None:
    """Add the file or the files of a command, and the arguments of :func:`load_file`."""
    parser.add_argument(
        'files', metavar='FILE', nargs='+' if takes_many else 1,
        help='an SDFormat file; - reads the standard input')
    add_loading_arguments(parser)


def add_loading_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of :func:`load_file`."""
    parser.add_argument(
        '-I', dest='resource_paths', metavar='DIR', action='append', default=[],
        type=argument_type(str, 'is not a directory', os.path.isdir),
        help='a directory to search for included models, before GZ_SIM_RESOURCE_PATH '
             'and SDF_PATH; may be given more than once')
    parser.add_argument(
        '--skip-missing', action='store_true',
        help='leave out includes that are not found, with a warning')


def add_kinds_argument(
    parser: argparse.ArgumentParser, what: str, default: Collection[Kind] = SHOWN_KINDS,
) -> None:
    """Add the argument ``--kinds``; ``what`` is its purpose, such as ``print only``."""
    labels = ','.join(kind.label for kind in SHOWN_KINDS if kind in default)
    instead = '' if default is SHOWN_KINDS else f'instead of {labels} '
    parser.add_argument(
        '--kinds', metavar='KIND[,KIND...]', type=_kinds_from_text, default=tuple(default),
        help=f'{instead}{what} these kinds: {_KIND_NAMES}')


def add_frame_arguments(
    parser: argparse.ArgumentParser, what: str = 'show frames of', verb: str = 'show',
) -> None:
    """Add the arguments of :func:`tf_options_from_arguments`, named as parameters of the node."""
    add_kinds_argument(parser, what, DEFAULT_KINDS)
    add_model_argument(parser, verb)
    parser.add_argument(
        '--frame-names', choices=[names.value for names in FrameNames],
        default=FrameNames.AUTO.value,
        help='scoped: frame ids with the names of all models around an element; relative: '
             'without the top-level model; auto: relative for a model file')


def add_reference_argument(parser: argparse.ArgumentParser, verb: str) -> None:
    """Add the argument ``--relative-to``, whose help begins with a verb."""
    parser.add_argument(
        '--relative-to', metavar='FRAME', default='',
        help=f'{verb} poses relative to this frame, by its name in SDF (robot::hand) or TF '
             '(robot/hand)')


def add_model_argument(parser: argparse.ArgumentParser, verb: str = 'show') -> None:
    """Add the argument ``--model``, whose help begins with a verb."""
    parser.add_argument(
        '--model', metavar='NAME', default='', help=f'{verb} only this model, such as robot::arm')


def tf_options_from_arguments(options: argparse.Namespace) -> TfOptions:
    """Return the elements that become frames, and the rules for their names."""
    return TfOptions(
        model=options.model, kinds=frozenset(options.kinds),
        frame_names=FrameNames(options.frame_names))


def _kinds_from_text(text: str) -> tuple[Kind, ...]:
    try:
        return tuple(_SHOWN_BY_NAME[name] for name in text.split(','))
    except KeyError as error:
        hint = hint_from_names(error.args[0], _SHOWN_BY_NAME)
        msg = f'"{error.args[0]}" is not a kind of element; known are {_KIND_NAMES}{hint}'
        raise argparse.ArgumentTypeError(msg) from None
