# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Read files in a process with limits, for the running node."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

from sdf_pose_bridge.errors import FileReadError, LimitError, PassingReadError, Place, SdfWarning
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.limited_process import (
    Allowance,
    LimitedProcess,
    LimitExceededError,
    ProcessEndedError,
)
from sdf_pose_bridge.tf.loaded_scene import (
    fingerprint_of_scene,
    loaded_scene_from_request,
    LoadedScene,
    LoadRequest,
)

if TYPE_CHECKING:
    from sdf_pose_bridge.tf.frame_setting import FrameChange
    from sdf_pose_bridge.tf.visual_markers import VisualMarker

ALLOWANCE = Allowance(
    memory_bytes=1_000_000_000, processor_s=20.0, wall_s=60.0,
    memory_bytes_per_megabyte=200_000_000, seconds_per_megabyte=10.0)
"""Limits for reading a file: several times the use of the largest files on slow machines."""

_Result = TypeVar('_Result')


class SceneReader:
    """
    Reads files in a separate process.

    All methods are thread-safe and wait for the process. They raise the exceptions of the
    functions that they call there, and

    :raises LimitError: if reading the file exceeds the limits.
    :raises FileReadError: if the process ends during the call, or cannot be started.
    :raises MemoryError: if the process has not enough memory.
    """

    def __init__(self) -> None:
        self._process = LimitedProcess(ALLOWANCE)

    def close(self) -> None:
        """End the process; another one is started when needed."""
        self._process.close()

    def loaded_scene(self, request: LoadRequest) -> LoadedScene:
        """Read a file or a text, as :func:`loaded_scene_from_request` does."""
        return self._result(request, loaded_scene_from_request, request)

    def markers(
        self, loaded: LoadedScene,
    ) -> tuple[list[VisualMarker], tuple[SdfWarning, ...]] | None:
        """Make the markers of a loaded scene, as :func:`markers_from_text` does."""
        # Imported here because it takes 6 ms, and few nodes have a listener.
        from sdf_pose_bridge.tf.visual_markers import markers_from_text
        return self._result(
            loaded.request, markers_from_text, loaded.text, loaded.path, loaded.request,
            fingerprint_of_scene(loaded.scene))

    def frame_change(
        self, loaded: LoadedScene, frame: str, asked: Pose, reference: str,
    ) -> FrameChange:
        """Find the change of a file, as :func:`frame_change_from_request` does."""
        # Imported here because it takes 7 ms, and few nodes write files.
        from sdf_pose_bridge.tf.frame_setting import frame_change_from_request
        return self._result(
            loaded.request, frame_change_from_request, loaded.request,
            fingerprint_of_scene(loaded.scene), frame, asked, reference,
            loaded.joint_positions)

    def _result(
        self, request: LoadRequest, function: Callable[..., _Result], *arguments: object,
    ) -> _Result:
        place = Place(request.source)
        try:
            return self._process.call(function, *arguments)
        except LimitExceededError as error:
            msg = f'the file needs {error} to be read'
            raise LimitError(msg, place) from None
        except ProcessEndedError as error:
            error_class = PassingReadError if error.may_pass else FileReadError
            raise error_class(str(error), place) from error
