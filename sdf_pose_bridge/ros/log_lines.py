# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Format errors and warnings as single lines for a log."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import compress
import sys
import traceback

from sdf_pose_bridge.errors import SdfError, shortened_message, UriLookupError
from sdf_pose_bridge.export.published_scene import LoadedScene
from sdf_pose_bridge.printed_text import printable, quoted_names
from sdf_pose_bridge.problems import by_message, MOST_PROBLEMS
from sdf_pose_bridge.ros.parameters.declarations import SettingsError
from sdf_pose_bridge.tf.parents import NO_PARENT
from sdf_pose_bridge.tf.tree import TfTree

MOST_LINES = 20
"""Largest number of errors, warnings or names in the log; a generated file may have thousands."""


def line_from_text(text: object) -> str:
    """Return text of others as one line for the log, with escapes and at most 2000 characters."""
    return printable(shortened_message(str(text)))


def text_about_defect(place: str) -> str:
    """Return the exception that is being handled; its traceback is indented below a line."""
    lines = lines_from_traceback(sys.exc_info()[1])
    return '\n'.join([f'internal error in {place}: {lines[-1].strip()}', *lines])


def lines_from_traceback(error: BaseException | None) -> list[str]:
    """Return the end of the traceback of an exception, indented, so that it forges no line."""
    place = error.__traceback__ if error else None
    text = ''.join(traceback.format_exception(None, error, place))
    return [f'    {line_from_text(each)}' for each in text.splitlines()[-MOST_PROBLEMS:]]


def lines_from_error(error: Exception) -> list[str]:
    """Return a line for each error, with the place in its file, as `lines_from_warnings`."""
    if isinstance(error, SdfError):
        hint = '; on_missing_include "skip" leaves it out'
        lines = [
            f'{each}{hint if isinstance(each, UriLookupError) else ""}{other_lines}'
            for each, other_lines in by_message(error.errors)]
        return lines_from_warnings(lines, 'error', '; "sdf_pose check" shows all of them')
    if isinstance(error, SettingsError):
        return lines_from_warnings(error.sentences, 'error')
    return [line_from_text(error)]


def lines_from_warnings(
    warnings: Sequence[object], what: str = 'warning', hint: str = '',
) -> list[str]:
    """
    Return at most ``MOST_LINES`` lines about warnings or other things, and one that counts others.

    :param hint: the end of that line.
    """
    lines = list(map(line_from_text, warnings[:MOST_LINES]))
    rest = len(warnings) - len(lines)
    if rest:
        at_least = 'at least ' if len(warnings) > MOST_PROBLEMS else ''
        lines.append(f'not shown: {at_least}{count_in_words(rest, f"more {what}")}{hint}')
    return lines


def names_in_line(names: Sequence[str]) -> str:
    """Return at most ``MOST_LINES`` names with commas, and the number of the others."""
    return line_from_text(quoted_names(names, MOST_LINES))


def line_about_frames(loaded: LoadedScene) -> str:
    """Return a line with the number of published frames, and their file."""
    count = count_in_words(len(loaded.tree.frame_ids), 'frame')
    return line_from_text(f'publishing {count} of {loaded.path}')


def lines_about_scene(loaded: LoadedScene) -> list[str]:
    """Return lines about a scene that is published now."""
    tree, prefix = loaded.tree, loaded.request.tf_options.frame_prefix
    transforms = count_in_words(tree.transform_count, 'transform')
    size = f'{line_about_frames(loaded)} with {transforms}, root frame "{tree.root_frame}"'
    lines = [f'{size} (read in {1e3 * loaded.seconds:.0f} ms)']
    if prefix[-1:].isalnum():
        lines.append(
            f'frame ids begin with frame_prefix "{prefix}", as in "{prefix}base_link"; did you '
            f'mean "{prefix}/"?')
    if loaded.gazebo_warning_count:
        lines.append(
            f'not shown: {count_in_words(loaded.gazebo_warning_count, "warning")} about Gazebo; '
            'for all warnings, type "sdf_pose check FILE", or "sdf_pose check -" for a text')
    return [*lines, *filter(None, [line_about_detached_models(tree)])]


def lines_about_lost_frames(before: TfTree, after: TfTree) -> list[str]:
    """Return a line about removed frames, and one about those without a parent now, if any."""
    had, have = (
        {*compress(each.frame_ids, (each.parents != NO_PARENT).tolist())}
        for each in (before, after))
    lost = had - have
    frames = {
        'no longer published, which TF listeners keep until they are restarted':
            lost.difference(after.frame_ids),
        'without a parent now; TF listeners keep the last transform until they are restarted':
            lost.intersection(after.frame_ids)}
    return [
        f'{count_in_words(len(found), "frame")} {what}: {names_in_line(sorted(found))}'
        for what, found in frames.items() if found]


def line_about_detached_models(tree: TfTree) -> str:
    """Return a line with the roots of trees without a parent frame; '' if there are none."""
    names = list(compress(tree.frame_ids, (tree.parents == NO_PARENT).tolist()))
    if not names:
        return ''
    what = 'the root of its tree' if len(names) == 1 else 'the roots of their trees'
    return (
        f'no transform to {names_in_line(names)}, {what}: odometry or localization can publish '
        f'one, or this node from "{tree.root_frame}" with anchor_models "all"')


def line_about_rest(tree: TfTree) -> str:
    """Return a line about joints and models that follow no messages; '' if all do."""
    parts = [
        f'{count_in_words(len(names), what)} that can move, for example {names_in_line(names[:1])}'
        for what, names in zip(('joint', 'model'), tree.at_rest, strict=True) if names]
    return '' if not parts else (
        f'fixed as in the file: {" and ".join(parts)}; with the parameter use_joint_states, '
        'joints follow the topics in joint_states_topics, and models those in model_pose_topics')


def count_in_words(number: int, what: str) -> str:
    """Return a number with a noun in the singular or the plural."""
    return f'{number} {what}' if number == 1 else f'{number} {what}s'
