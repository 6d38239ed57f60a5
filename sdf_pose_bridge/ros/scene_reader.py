# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Read files in processes with limits, for the node."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from sdf_pose_bridge.errors import FileReadError, LimitError, PassingReadError, Place
from sdf_pose_bridge.limited_process import LimitedProcess, ProcessEndedError
from sdf_pose_bridge.process_limits import FOR_FILES, LimitExceededError
from sdf_pose_bridge.tf.loaded_scene import LoadedScene, LoadRequest

_Result = TypeVar('_Result')


def _prepare() -> None:
    """Import what reads files, while the node itself imports ROS."""
    import sdf_pose_bridge.sdformat.include.expansion
    import sdf_pose_bridge.tf.loading  # noqa: F401


def _loaded_scene(request: LoadRequest) -> LoadedScene:
    from sdf_pose_bridge.tf.loading import loaded_scene_from_request
    return loaded_scene_from_request(request)


class SceneReader(LimitedProcess):
    """
    Reads files, each in a process of its own that is forked from this one.

    It must be made by the main thread before ROS is imported, which starts threads. All methods
    are thread-safe and wait for the process. They raise the exceptions of the functions that they
    call there, and

    :raises LimitError: if reading the file exceeds the limits.
    :raises FileReadError: if the process ends during the call, or cannot be started.
    :raises MemoryError: if there is no memory for the result.
    """

    def __init__(self) -> None:
        super().__init__(_prepare)

    def loaded_scene(
        self, request: LoadRequest, meanwhile: Callable[[], None] | None = None,
    ) -> LoadedScene:
        """
        Read a file or a text, as :func:`sdf_pose_bridge.tf.loading.loaded_scene_from_request`.

        :param meanwhile: a function to call here while it is read.
        """
        return self.result(request, _loaded_scene, request, meanwhile=meanwhile)

    def result(
        self, request: LoadRequest, function: Callable[..., _Result], *arguments: object,
        meanwhile: Callable[[], None] | None = None,
    ) -> _Result:
        """
        Call a function that reads the files of a request.

        :param function: a function of a module; its arguments and result can be pickled.
        :param meanwhile: a function to call here while the other one runs.
        """
        place = Place(request.source)
        try:
            return self.call(FOR_FILES, function, *arguments, meanwhile=meanwhile)
        except LimitExceededError as error:
            msg = f'the file needs {error} to be read'
            raise LimitError(msg, place) from None
        except ProcessEndedError as error:
            error_class = PassingReadError if error.may_pass else FileReadError
            raise error_class(str(error), place) from error
