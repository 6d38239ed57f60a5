# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The node: publishes a file, and follows changes of its parameters and of the file."""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Sequence
import contextlib
import time
import traceback
from typing import TYPE_CHECKING

from rcl_interfaces.msg import SetParametersResult
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.clock import Clock
from rclpy.clock import ClockType
from rclpy.exceptions import InvalidHandle
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.task import Future
from rclpy.timer import Timer
from std_srvs.srv import Trigger

from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.ros.background import run_in_thread
from sdf_pose_bridge.ros.diagnostics import Diagnostics
from sdf_pose_bridge.ros.diagnostics import PERIOD_S
from sdf_pose_bridge.ros.file_watcher import FileWatcher
from sdf_pose_bridge.ros.file_watcher import PollingThread
from sdf_pose_bridge.ros.loaded_scene import files_behind_error
from sdf_pose_bridge.ros.loaded_scene import loaded_scene_from_settings
from sdf_pose_bridge.ros.loaded_scene import LoadedScene
from sdf_pose_bridge.ros.log_lines import lines_from_error
from sdf_pose_bridge.ros.log_lines import lines_from_warnings
from sdf_pose_bridge.ros.log_lines import names_in_line
from sdf_pose_bridge.ros.parameter_service import AtomicParameterService
from sdf_pose_bridge.ros.parameters import changed_settings
from sdf_pose_bridge.ros.parameters import Settings
from sdf_pose_bridge.ros.parameters import SettingsError
from sdf_pose_bridge.ros.publishers import FramePublishers
from sdf_pose_bridge.ros.services import add_services
from sdf_pose_bridge.ros.services import SERVICE_QOS
from sdf_pose_bridge.ros.topic_names import are_too_many_by_default
from sdf_pose_bridge.ros.topic_names import LONGEST_FULL_NAME
from sdf_pose_bridge.ros.topic_names import LONGEST_NAME
from sdf_pose_bridge.ros.topic_names import MOST_BY_DEFAULT
from sdf_pose_bridge.ros.topic_names import SHORTEST_LIMIT
from sdf_pose_bridge.ros.topic_names import Topics
from sdf_pose_bridge.ros.topic_names import topics_from_patterns
from sdf_pose_bridge.sdformat.include.uris import AddressError

if TYPE_CHECKING:
    from sdf_pose_bridge.ros.joint_states import JointStates
    from sdf_pose_bridge.ros.visuals import VisualPublisher


class SdfPoseBridge:
    """
    What the node does once ``/tf_static`` is published.

    :param node: the node, with declared parameters.
    :param publishers: its publishers of frames, which have published the scene on ``/tf_static``.
    :param settings: its settings.
    :param loaded: the scene.
    """

    def __init__(
        self, node: Node, publishers: FramePublishers, settings: Settings, loaded: LoadedScene,
    ) -> None:
        self._node = node
        self._logger = node.get_logger()
        self._publishers = publishers
        self._settings = settings
        self._loaded = loaded
        self._failure: list[str] = []
        # A failure that was not reported yet, because the file may still be being written.
        self._pending_failure: list[str] = []
        self._diagnostics = Diagnostics(node)
        self._watcher = FileWatcher()
        # All callbacks that change what is published: one runs after the other.
        self._changes = MutuallyExclusiveCallbackGroup()
        # Simulated time may stand still.
        self._steady_clock = Clock(clock_type=ClockType.STEADY_TIME)
        self._again_timer: Timer | None = None
        self._joint_states: JointStates | None = None
        self._visuals: VisualPublisher | None = None

    async def start(self) -> None:
        """Publish the scene on all other topics, and offer services."""
        self._follow_joints(self._loaded)
        await self._serve(self._loaded)
        self._publish_again_at(self._settings.publish_rate)
        add_services(self._node, lambda: self._loaded.lookup)
        self._node.create_service(
            Trigger, '~/reload', self._answer_to_reload, qos_profile=SERVICE_QOS,
            callback_group=self._changes)
        self._parameter_service = AtomicParameterService(
            self._node, self._changes, self._set_parameters)
        self._node.create_timer(PERIOD_S, self._diagnostics.publish, clock=self._steady_clock)
        guard_condition = self._node.create_guard_condition(
            self._check_files, callback_group=self._changes)

        def trigger() -> None:
            # The node may have been destroyed.
            with contextlib.suppress(InvalidHandle):
                guard_condition.trigger()

        self._polling = PollingThread(self._has_to_check_files, trigger)
        # Imported here because everything else is more urgent.
        from sdf_pose_bridge.ros.visuals import VisualPublisher
        self._visuals = VisualPublisher(self._node, self._loaded, self._settings)

    # Loading

    def _load(self, settings: Settings) -> Future:
        return run_in_thread(self._node, lambda: loaded_scene_from_settings(settings))

    async def _replace(self, loaded: LoadedScene) -> None:
        """Publish another scene; nothing has changed before this call."""
        self._publishers.publish_tf_static(loaded.tree)
        self._follow_joints(loaded)
        await self._serve(loaded)

    async def _serve(self, loaded: LoadedScene) -> None:
        """Take a scene into use that is published on ``/tf_static``."""
        self._loaded = loaded
        self._failure = self._pending_failure = []
        self._watcher.watch(loaded.files, loaded.read_since_ns)
        await self._publish_topics()
        for line in lines_from_warnings(loaded.warnings):
            self._logger.warning(line)
        self._logger.info(
            f'publishing {_count(len(loaded.tree.frame_ids), "frame")} of {loaded.path} with '
            f'{_count(loaded.tree.transform_count, "transform")}, root frame '
            f'"{loaded.tree.root_frame}" (read in {1e3 * loaded.seconds:.0f} ms)')
        self._diagnostics.update(loaded)
        if self._visuals is not None:
            self._visuals.replace(loaded, self._settings)

    def _follow_joints(self, loaded: LoadedScene) -> None:
        """Publish what joints move on ``/tf``, if they follow ``joint_states``."""
        tree, positions = loaded.tree, loaded.joint_positions
        if tree.moving is None or positions is None:
            if self._joint_states is not None:
                self._joint_states.destroy()
                self._joint_states = None
        elif self._joint_states is not None:
            self._joint_states.replace(tree, tree.moving, positions)
        else:
            # Imported here because most often joints do not move.
            from sdf_pose_bridge.ros.joint_states import JointStates
            self._joint_states = JointStates(self._node, tree, tree.moving, positions)
            self._joint_states.is_published_later = self._settings.publish_rate > 0.0

    async def _publish_topics(self) -> None:
        frame_ids = set(self._loaded.tree.frame_ids)
        topics = await self._pose_topics()
        if self._joint_states is not None:
            self._joint_states.set_pose_publishers(None)
        changed = await self._publishers.publish_topics(topics)
        if self._joint_states is not None:
            self._joint_states.set_pose_publishers(self._publishers)
        vanished = [frame_id for frame_id in changed if frame_id not in frame_ids]
        if vanished:
            self._logger.warning(
                f'{_count(len(vanished), "frame")} no longer published, which TF listeners keep '
                f'until they are restarted: {names_in_line(vanished)}')
        detached = [frame_id for frame_id in changed if frame_id in frame_ids]
        if detached:
            self._logger.warning(
                f'{_count(len(detached), "frame")} without a parent now; TF listeners keep the '
                f'last transform until they are restarted: {names_in_line(detached)}')

    async def _pose_topics(self) -> Mapping[str, str]:
        """Return the names of the pose topics by frame id."""
        patterns = self._settings.pose_topics
        frame_ids = self._loaded.tree.frame_ids
        if are_too_many_by_default(frame_ids, patterns):
            self._logger.warning(
                f'no ~/poses/... topics: {len(frame_ids)} frames are more than {MOST_BY_DEFAULT}; '
                'name those that you want in pose_topics, such as "robot/*", or ask for all with '
                '"?*"')
            return {}
        room = LONGEST_FULL_NAME - len(f'{self._node.get_fully_qualified_name()}/poses/')
        if room < SHORTEST_LIMIT:
            self._logger.warning(
                'no ~/poses/... topics: the name of the node and its namespace are so long that '
                'the names of topics would be longer than the middleware allows')
            return {}
        topics: Topics = await run_in_thread(
            self._node,
            lambda: topics_from_patterns(frame_ids, patterns, min(room, LONGEST_NAME)))
        if topics.unmatched:
            self._logger.warning(
                f'no ~/poses/... topics for {names_in_line(topics.unmatched)} in pose_topics: no '
                'frame id matches')
        return topics.names

    async def _reload(self) -> list[str]:
        """Read the file again; return the errors, which leave everything as it was."""
        try:
            await self._replace(await self._load(self._settings))
        except Exception as error:  # noqa: BLE001 - includes defects
            self._watcher.watch_also(files_behind_error(error, self._settings))
            return self._lines_from_error(error)
        return []

    def _lines_from_error(self, error: Exception) -> list[str]:
        if isinstance(error, SdfError | SettingsError | AddressError):
            return lines_from_error(error)
        self._logger.error(f'internal error:\n{traceback.format_exc()}')
        return [f'internal error, see the log of the node: {error!r}']

    def _report_failure(self, lines: list[str]) -> None:
        if lines != self._failure:
            self._logger.error(
                f'{self._settings.sdf_file} is not taken; what was published before stays')
            for line in lines:
                self._logger.error(line)
        self._failure, self._pending_failure = lines, []
        self._diagnostics.update(self._loaded, lines)

    async def _answer_to_reload(
        self, _request: Trigger.Request, response: Trigger.Response,
    ) -> Trigger.Response:
        failure = await self._reload()
        if failure:
            self._report_failure(failure)
        response.success = not failure
        response.message = '; '.join(failure) or (
            f'publishing {_count(len(self._loaded.tree.frame_ids), "frame")} of '
            f'{self._loaded.path}')
        return response

    # Changes of files

    def _has_to_check_files(self) -> bool:
        return self._settings.watch and (bool(self._pending_failure) or self._watcher.differs())

    async def _check_files(self) -> None:
        """
        Reload if a file has changed.

        Somebody may still be writing the file, so a failure is reported only if the files do not
        change during the next period, or if the next reload fails in the same way.
        """
        try:
            before = self._pending_failure
            if self._watcher.has_changed():
                self._pending_failure = await self._reload()
                if self._pending_failure != before:
                    return
            if self._pending_failure:
                self._report_failure(self._pending_failure)
        finally:
            self._polling.resume()

    # Changes of parameters

    async def _set_parameters(self, parameters: Sequence[Parameter]) -> SetParametersResult:
        """Set parameters if all settings, and the file that they name, are valid."""
        try:
            settings = changed_settings(self._settings, parameters)
            loaded = None
            if settings.needs_load_after(self._settings) or any(
                    parameter.name == 'sdf_file' for parameter in parameters):
                loaded = await self._load(settings)
            result = self._node.set_parameters_atomically(parameters)
            if result.successful:
                await self._apply(settings, loaded)
        except Exception as error:  # noqa: BLE001 - the client must be answered
            reason = '; '.join(self._lines_from_error(error))
            return SetParametersResult(successful=False, reason=reason)
        return result

    async def _apply(self, settings: Settings, loaded: LoadedScene | None) -> None:
        before, self._settings = self._settings, settings
        if loaded is not None:
            await self._replace(loaded)
        elif settings.pose_topics != before.pose_topics:
            await self._publish_topics()
        if settings.publish_rate != before.publish_rate:
            self._publish_again_at(settings.publish_rate)
            if self._joint_states is not None:
                self._joint_states.is_published_later = settings.publish_rate > 0.0

    # Publishing again

    def _publish_again_at(self, rate: float) -> None:
        if self._again_timer is not None:
            self._node.destroy_timer(self._again_timer)
            self._again_timer = None
        if rate:
            self._again_timer = self._node.create_timer(
                1.0 / rate, self._publish_again, callback_group=self._changes,
                clock=self._steady_clock)

    async def _publish_again(self) -> None:
        begin = time.perf_counter()
        await self._publishers.publish_again()
        if self._joint_states is not None:
            self._joint_states.publish_waiting()
        seconds = time.perf_counter() - begin
        if seconds * self._settings.publish_rate > 1.0:
            self._logger.warning(
                f'publish_rate {self._settings.publish_rate} Hz is not reached: to publish '
                f'everything takes {1e3 * seconds:.0f} ms', throttle_duration_sec=60.0)


def _count(number: int, what: str) -> str:
    return f'{number} {what}' if number == 1 else f'{number} {what}s'
