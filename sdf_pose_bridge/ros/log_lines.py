# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Format errors and warnings as single lines for a log."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import compress
import sys
import time
import traceback
from typing import Any

import numpy as np

from sdf_pose_bridge.errors import SdfError, shortened_message, UriLookupError
from sdf_pose_bridge.export.published_scene import LoadedScene
from sdf_pose_bridge.printed_text import printable, quoted_names
from sdf_pose_bridge.problems import by_message, MOST_PROBLEMS
from sdf_pose_bridge.ros.parameters.declarations import SettingsError
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.tf.frame_ids import FrameNames, FrameNaming
from sdf_pose_bridge.tf.joint_motion import dofs_from_joint
from sdf_pose_bridge.tf.parents import NO_PARENT
from sdf_pose_bridge.tf.tree import elements_in_model, TfTree

MOST_LINES = 20
"""Largest number of errors, warnings or names in the log; a generated file may have thousands."""


WARNING_PERIOD_S = 10.0
"""Shortest period in s of warnings about the same thing."""

MOST_REPORTED = 1000
"""Largest number of names that are kept because they were reported."""


class RareWarnings:
    """
    Logs warnings that many messages may cause, each of them rarely.

    :param logger: the logger of the node.
    """

    def __init__(self, logger: Any) -> None:
        self._logger = logger
        self._warnings_due: dict[str, float] = {}
        self._reported_names: set[str] = set()

    def is_due(self, about: str) -> bool:
        """Return whether the last warning about the same was long ago."""
        return time.monotonic() >= self._warnings_due.get(about, 0.0)

    def warn(self, about: str, text: Callable[[], str]) -> bool:
        """Log a warning, unless the last one about the same was not long ago."""
        is_due = self.is_due(about)
        if is_due:
            self._warnings_due[about] = time.monotonic() + WARNING_PERIOD_S
            self._logger.warning(line_from_text(text()))
        return is_due

    def warn_once(self, about: str, names: Sequence[str], text: Callable[[], str]) -> None:
        """Log a warning about names, unless all of them have been reported before."""
        if not self._reported_names.issuperset(names) and self.warn(about, text):
            self._reported_names.update(names[:MOST_REPORTED - len(self._reported_names)])


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
    """
    Return one line for each error.

    :param error: an error of this package; lines about a file start with its path and line.
    :return: at least one line and at most ``MOST_LINES``, and one more if there are more errors.
    """
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
    Return one line for each warning, or for other things.

    :param warnings: objects with a text for ``str``.
    :param hint: the end of the line that counts the others.
    :return: at most ``MOST_LINES`` lines, and one more if there are more warnings.
    """
    lines = list(map(line_from_text, warnings[:MOST_LINES]))
    rest = len(warnings) - len(lines)
    if rest:
        at_least = 'at least ' if len(warnings) > MOST_PROBLEMS else ''
        lines.append(f'not shown: {at_least}{count_in_words(rest, f"more {what}")}{hint}')
    return lines


def names_in_line(names: Sequence[str]) -> str:
    """
    Return names separated by commas.

    :return: at most ``MOST_LINES`` names, and the number of the others.
    """
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
    """
    Return lines about frames that have lost their transforms; TF cannot forget them.

    :param before: the tree that was published before.
    :param after: the tree that is published now.
    :return: a line about removed frames, and one about frames without a parent, if any.
    """
    lost = _children(before) - _children(after)
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


def line_about_joints_at_rest(scene: Scene, model: str, frame_names: FrameNames) -> str:
    """
    Return a line that joints do not move; '' if no joint can move.

    Joints that follow others are not counted, as in ``StateReport``.

    :param model: the scoped name of the only model that is published; empty for everything.
    :param frame_names: the part of a scoped name that the name of a joint contains.
    """
    is_inside = elements_in_model(scene, model)
    free = [
        dofs[0] for joint in scene.joints
        if is_inside[joint.element]
        and (dofs := [dof for dof in dofs_from_joint(joint) if dof.axis.mimic is None])
        and not scene.is_static(joint.element)]
    if not free:
        return ''
    first = np.array([free[0].joint.element], np.int32)
    name = FrameNaming(frame_names).frame_ids_from_scene(scene, first)[0] + free[0].suffix
    return (
        f'fixed as in the file: {count_in_words(len(free), "joint")} that can move, for example '
        f'{names_in_line([name])}; with the parameter use_joint_states, joints follow the topics '
        'in joint_states_topics')


def count_in_words(number: int, what: str) -> str:
    """Return a number with a noun in the singular or the plural."""
    return f'{number} {what}' if number == 1 else f'{number} {what}s'


def _children(tree: TfTree) -> set[str]:
    return set(compress(tree.frame_ids, (tree.parents != NO_PARENT).tolist()))
