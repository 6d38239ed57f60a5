# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Print results for other programs: as JSON, as CSV, or as annotations of a code review."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Mapping, Sequence
import csv
import json
import sys
from typing import Any

from sdf_pose_bridge.errors import SdfError, SdfWarning
from sdf_pose_bridge.names import printable

TEXT, CSV, JSON, GITHUB = 'text', 'csv', 'json', 'github'
"""The values of ``--format``."""

_MEANINGS = {
    TEXT: 'for people, the default',
    CSV: 'comma-separated values with a header, in metres and radians',
    JSON: 'one object per file and line, in metres and radians',
    GITHUB: 'annotations that GitHub shows in a review',
}

_ESCAPES: Mapping[str, str] = {'%': '%25', '\r': '%0D', '\n': '%0A'}
_ESCAPES_OF_PROPERTIES: Mapping[str, str] = {**_ESCAPES, ':': '%3A', ',': '%2C'}


def add_format_argument(parser: argparse.ArgumentParser, *formats: str) -> None:
    """
    Add the argument ``--format``.

    :param formats: its values besides ``text``.
    """
    meanings = ', '.join(f'{name}: {_MEANINGS[name]}' for name in (TEXT, *formats))
    parser.add_argument(
        '--format', choices=(TEXT, *formats), default=TEXT, help=f'output format: {meanings}')


def print_json(
    path: str, errors: Sequence[SdfError], warnings: Sequence[SdfWarning], **content: Any,
) -> None:
    """
    Print a line with a JSON object about a file.

    :param content: further members of the object.
    """
    print(json.dumps({
        'file': path, 'ok': not errors, 'errors': [*map(_problem, errors)],
        'warnings': [*map(_problem, warnings)], **content}))


def print_csv_header(columns: Sequence[str]) -> None:
    """Print the header line of comma-separated values."""
    csv.writer(sys.stdout, lineterminator='\n').writerow(columns)


def print_csv(columns: Sequence[str], records: Iterable[Mapping[str, Any]]) -> None:
    """
    Print comma-separated values without a header.

    Numbers have all their digits. Characters that control a terminal are escaped.

    :param columns: keys of the records, in the order of printing; a missing value is left empty.
    """
    csv.writer(sys.stdout, lineterminator='\n').writerows(
        [printable(value) if isinstance(value, str) else value
         for value in map(record.get, columns)] for record in records)


def print_annotations(problems: Iterable[SdfError | SdfWarning]) -> None:
    """
    Print problems as workflow commands of GitHub Actions, for annotations in a review.

    Source of the syntax and the escapes: "Workflow commands for GitHub Actions" of its
    documentation, and ``command.ts`` of its toolkit.
    """
    for problem in problems:
        level = 'error' if isinstance(problem, SdfError) else 'warning'
        place = problem.place
        line = f',line={place.line}' if place.line else ''
        print(f'::{level} file={_escaped(printable(place.file), _ESCAPES_OF_PROPERTIES)}{line},'
              f'title={problem.code}::{_escaped(printable(problem.message), _ESCAPES)}')


def _problem(problem: SdfError | SdfWarning) -> dict[str, Any]:
    return {'code': problem.code, 'message': problem.message, **problem.place._asdict()}


def _escaped(text: str, escapes: Mapping[str, str]) -> str:
    return ''.join(escapes.get(character, character) for character in text)
