# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The report of the thread that follows messages about joints and models."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from sdf_pose_bridge.ros.log_lines import count_in_words, names_in_line


class StateReport(NamedTuple):
    """Joints and models that no message has reported, and problems of messages."""

    joints: Sequence[str] = ()
    """A name of each such joint that follows no other one."""
    models: Sequence[str] = ()
    """The names of such models."""
    topics: Sequence[str] = ()
    """The full names of the topics on which messages can name the first joint."""
    problems: Sequence[str] = ()
    """A line for each source of messages with old stamps, and for other publishers of frames."""
    failures: Sequence[str] = ()
    """A line for each source whose messages end in internal errors."""

    def line_about_unreported(self) -> str:
        """Return a line with the numbers of joints and models; '' if all are reported."""
        parts = []
        if self.joints:
            parts.append(
                f'no message has named {count_in_words(len(self.joints), "joint")} yet, for '
                f'example {names_in_line(self.joints[:1])}; frames that a joint moves have no '
                f'transforms until a message on {" or ".join(self.topics) or "a topic"} names the '
                'joint, or with unreported_joints:=zero')
        if self.models:
            parts.append(
                f'no pose has come yet for {count_in_words(len(self.models), "model")}, for '
                f'example {names_in_line(self.models[:1])}; its frames have no transform from '
                'the root until a message has its pose')
        return '; '.join(parts)
