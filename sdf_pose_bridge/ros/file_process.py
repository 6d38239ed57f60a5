# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Read and write files in processes with limits, for the node."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar

from sdf_pose_bridge.export.published_scene import LoadedScene, LoadRequest
from sdf_pose_bridge.limited_process import Call, LimitedProcess
from sdf_pose_bridge.problems import errors_of_process
from sdf_pose_bridge.process_limits import FOR_FILES

_Result = TypeVar('_Result')


def _prepare() -> None:
    """Import what reads files, while the node itself imports ROS."""
    import sdf_pose_bridge.export.pose_setting
    import sdf_pose_bridge.sdformat.include.expansion  # noqa: F401


def loaded_scene(request: LoadRequest) -> LoadedScene:
    """Do what ``loaded_scene_from_request`` does, which the node need not import."""
    from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request
    return loaded_scene_from_request(request)


class FileProcess(LimitedProcess):
    """
    Reads files, each in a process of its own that is forked from this one.

    It must be made by the main thread before ROS is imported, which starts threads. All methods
    are thread-safe.
    """

    def __init__(self) -> None:
        super().__init__(_prepare)

    @contextmanager
    def calling(
        self, request: LoadRequest, function: Callable[..., _Result], *arguments: object,
    ) -> Iterator[Call[_Result]]:
        """
        Call a function that reads or writes the files of a request; it ends with the block.

        :param function: a function of a module; its arguments and result can be pickled.
        :return: a context manager with the call. Errors of :func:`errors_of_process` also come
            from the block.
        """
        with (errors_of_process(request.source),
              self.start(FOR_FILES, function, *arguments) as call):
            yield call
