# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The node: publishes a file, and follows changes of its parameters and of the file."""

from __future__ import annotations

from collections.abc import Sequence
import contextlib
import time
import traceback
from typing import TYPE_CHECKING

from rcl_interfaces.msg import SetParametersResult
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.task import Future
from std_msgs.msg import String
from std_srvs.srv import Trigger

from sdf_pose_bridge.errors import AddressError, SdfError
from sdf_pose_bridge.problems import folded
from sdf_pose_bridge.ros.background import CoroutineLock, PollingThread, Worker
from sdf_pose_bridge.ros.cdr import NANOSECONDS
from sdf_pose_bridge.ros.diagnostics import Diagnostics, PERIOD_S
from sdf_pose_bridge.ros.file_follower import FileFollower
from sdf_pose_bridge.ros.given_parameters import changed_settings, ParameterServices
from sdf_pose_bridge.ros.log_lines import (
    line_about_frames,
    line_about_joints_at_rest,
    lines_about_lost_frames,
    lines_about_scene,
    lines_from_error,
    lines_from_warnings,
    MissingJoints,
)
from sdf_pose_bridge.ros.parameters import Settings, SettingsError
from sdf_pose_bridge.ros.published_frames import frames_from_scene, PublishedFrames
from sdf_pose_bridge.ros.publishers import SwitchedPublisher, Topic
from sdf_pose_bridge.ros.scene_reader import SceneReader
from sdf_pose_bridge.ros.services import add_services, SERVICE_QOS, set_pose
from sdf_pose_bridge.ros.topic_names import (
    check_number_of_topics,
    joint_state_topics_from_patterns,
)
from sdf_pose_bridge.tf.loaded_scene import LoadedScene
from sdf_pose_bridge.tf.loading import files_behind_error
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge_interfaces.srv import SetPose

if TYPE_CHECKING:
    from sdf_pose_bridge.ros.joint_states import JointStates


class SdfPoseBridge:
    """
    The node after the first scene is published.

    :param node: the node, with declared parameters and an executor.
    :param frames: the frames of the scene, which are published.
    :param parameter_services: those of the node, which answer from then on.
    :param worker: does what would block the executor.
    """

    def __init__(
        self, node: Node, frames: PublishedFrames, settings: Settings, loaded: LoadedScene,
        reader: SceneReader, parameter_services: ParameterServices, worker: Worker,
    ) -> None:
        self._node = node
        self._logger = node.get_logger()
        self._frames = frames
        self._settings = settings
        self._loaded = loaded
        self._reader = reader
        self._worker = worker
        self._joint_states: JointStates | None = None
        self._diagnostics = Diagnostics(
            node, lambda: self._joint_states.unreported if self._joint_states else MissingJoints())
        self._has_told_of_joints = False
        self._follower = FileFollower(loaded)
        # All callbacks that change the published scene run one after the other.
        self._changes = parameter_services.group
        # Held while publishing on all topics. A timer that is always due would block the callbacks
        # of its group, so it has a separate group.
        self._publishing = CoroutineLock(node)
        # Simulated time may stand still.
        steady_clock = Clock(clock_type=ClockType.STEADY_TIME)
        self._again_timer = node.create_timer(
            1.0, self._publish_again, callback_group=MutuallyExclusiveCallbackGroup(),
            clock=steady_clock, autostart=False)
        self._publish_again_at(settings.publish_rate)
        self._follow_joints()
        add_services(node, self._current_lookup)
        node.create_service(
            Trigger, '~/reload', self._answer_to_reload, qos_profile=SERVICE_QOS,
            callback_group=self._changes)
        if settings.allow_set_pose:
            node.create_service(
                SetPose, '~/set_pose', self._answer_to_set_pose, qos_profile=SERVICE_QOS,
                callback_group=self._changes)
        parameter_services.start(self._set_parameters)
        node.create_timer(PERIOD_S, self._diagnostics.publish, clock=steady_clock)
        PollingThread(
            node, self._changes,
            lambda: self._settings.watch and self._follower.is_due(), self._check_files)
        self._report_success()
        # Imported here because it is slow to import, and everything else is more urgent.
        from sdf_pose_bridge.ros.visuals import VisualPublisher
        # With the quality of service that it has in robot_state_publisher.
        self._robot_description = SwitchedPublisher(node, Topic('robot_description', String))
        self._publish_robot_description()
        self._visuals = VisualPublisher(node, self._reader, loaded)
        self._follow_switches()

    # Loading

    def _load(self, settings: Settings) -> Future:
        return self._worker.run(lambda: self._reader.loaded_scene(settings.load_request))

    async def _show(self, loaded: LoadedScene) -> None:
        """Publish a scene on the topics of the settings, unless they would be too many."""
        check_number_of_topics(self._settings.joint_states_topics, loaded.joint_positions)
        frames = await frames_from_scene(
            self._node, self._worker, loaded, self._settings, self._frames)
        async with self._publishing:
            before, self._loaded, self._frames = self._loaded, loaded, frames
            self._follow_joints()
            # From then on, nothing publishes the frames before.
            await self._process_messages()
            if loaded is not before:
                frames.publish_tf_static()
            await frames.publish_topics()
            if self._joint_states is not None:
                self._joint_states.publish_topics()
        if loaded is not before:
            await self._worker.run(lambda: self._follower.follow(loaded))
            for line in await self._worker.run(
                    lambda: lines_about_lost_frames(before.tree, loaded.tree)):
                self._logger.warning(line)
            self._report_success()
            self._publish_robot_description()
            self._visuals.replace(loaded)

    def _follow_joints(self) -> None:
        """Subscribe to joint states if moving frames follow them."""
        settings, moving, current = self._settings, self._frames.moving, self._joint_states
        if moving is None:
            if current is not None:
                current.end()
                self._joint_states = None
            return
        topics = joint_state_topics_from_patterns(
            settings.joint_states_topics, self._loaded.tree.world, moving.positions.models,
            self._node.resolve_topic_name)
        # Imported here because it takes 8 ms, and joints do not move by default.
        from sdf_pose_bridge.ros.joint_states import JointStates
        if current is not None:
            current.follow(moving, topics, settings)
        else:
            self._joint_states = JointStates(self._node, moving, topics, settings)

    async def _current_lookup(self) -> PoseLookup:
        await self._process_messages()
        return self._loaded.lookup

    async def _process_messages(self) -> None:
        """Wait until the messages of joint states so far are processed."""
        if self._joint_states is not None:
            await self._joint_states.catch_up()

    def _follow_switches(self) -> None:
        self._diagnostics.switch(on=self._settings.publish_diagnostics)
        self._visuals.switch(on=self._settings.publish_visuals)

    def _publish_robot_description(self) -> None:
        text = self._loaded.description if self._settings.publish_robot_description else ''
        self._robot_description.switch(on=bool(text))
        self._robot_description.publish(String(data=text))

    def _report_success(self) -> None:
        loaded = self._loaded
        for line in lines_from_warnings([
                f'{each}{other_lines}' for each, other_lines in folded(loaded.warnings)]):
            self._logger.warning(line)
        for line in lines_about_scene(loaded):
            self._logger.info(line)
        if not loaded.tree.moving and not self._has_told_of_joints:
            options = loaded.request.tf_options
            line = line_about_joints_at_rest(loaded.scene, options.model, options.frame_names)
            if line:
                self._logger.info(line)
                self._has_told_of_joints = True
        self._diagnostics.update(loaded)

    async def _reload(self) -> list[str]:
        """Read the files again; return the errors, after which nothing has changed."""
        try:
            await self._show(await self._load(self._settings))
        except Exception as error:  # noqa: BLE001 - includes defects
            files = files_behind_error(error, self._settings.load_request)
            self._follower.retry_after(error)
            with contextlib.suppress(MemoryError):  # it is read again then
                await self._worker.run(lambda: self._follower.follow_also(files))
            return self._lines_from_error(error)
        return []

    def _lines_from_error(self, error: Exception) -> list[str]:
        if isinstance(error, SdfError | SettingsError | AddressError):
            return lines_from_error(error)
        if isinstance(error, MemoryError):
            return ['there is not enough memory to read the file']
        self._logger.error(f'internal error:\n{traceback.format_exc()}')
        return [f'internal error, see the log of the node: {error!r}']

    def _report_failure(self, lines: list[str]) -> None:
        if lines:
            source = self._settings.load_request.source
            self._logger.error(f'{source} is rejected; the frames published before stay')
            for line in lines:
                self._logger.error(line)
            self._diagnostics.update(self._loaded, lines)

    async def _answer_to_reload(
        self, _request: Trigger.Request, response: Trigger.Response,
    ) -> Trigger.Response:
        failure = await self._reload()
        self._report_failure(self._follower.unreported(failure))
        response.success = not failure
        response.message = '; '.join(failure) or line_about_frames(self._loaded)
        return response

    async def _answer_to_set_pose(
        self, request: SetPose.Request, response: SetPose.Response,
    ) -> SetPose.Response:
        """Write a measured pose, and respond when it is published."""
        await self._process_messages()
        loaded = self._loaded
        try:
            answer: SetPose.Response = await self._worker.run(
                lambda: set_pose(request, loaded, self._reader))
            if not request.dry_run:
                await self._show(await self._load(self._settings))
        except Exception as error:  # noqa: BLE001 - the client must be answered
            response.message = '; '.join(self._lines_from_error(error))
            return response
        return answer

    async def _check_files(self) -> None:
        with contextlib.suppress(MemoryError):  # they are checked again after a period
            failure = None
            if await self._worker.run(self._follower.has_to_read):
                failure = await self._reload()
            self._report_failure(self._follower.failure_of_period(failure))

    # Changes of parameters

    async def _set_parameters(self, parameters: Sequence[Parameter]) -> SetParametersResult:
        """Set parameters if all settings, and the file that they name, are valid."""
        try:
            settings = changed_settings(self._settings, parameters)
            loaded = self._loaded
            if settings.needs_load_after(self._settings) or any(
                    parameter.name in ('sdf_file', 'robot_description')
                    for parameter in parameters):
                loaded = await self._load(settings)
            check_number_of_topics(settings.joint_states_topics, loaded.joint_positions)
            result = self._node.set_parameters_atomically(parameters)
            if result.successful:
                await self._apply(settings, loaded)
        except Exception as error:  # noqa: BLE001 - the client must be answered
            reason = '; '.join(self._lines_from_error(error))
            return SetParametersResult(successful=False, reason=reason)
        return result

    async def _apply(self, settings: Settings, loaded: LoadedScene) -> None:
        before, self._settings = self._settings, settings
        self._publish_again_at(settings.publish_rate)
        if loaded is not self._loaded or (
                settings.pose_topics, settings.publish_transforms) != (
                    before.pose_topics, before.publish_transforms):
            await self._show(loaded)
        self._follow_joints()
        self._follow_switches()
        if settings.publish_robot_description != before.publish_robot_description:
            self._publish_robot_description()

    # Publishing again

    def _publish_again_at(self, rate: float) -> None:
        self._again_timer.cancel()
        if rate:
            self._again_timer.timer_period_ns = round(NANOSECONDS / rate)
            self._again_timer.reset()

    async def _publish_again(self) -> None:
        async with self._publishing:
            begin = time.perf_counter()
            await self._frames.publish_fixed_again()
        seconds = time.perf_counter() - begin
        if seconds * self._settings.publish_rate > 1.0:
            # Missed periods are left out.
            self._again_timer.reset()
            self._logger.warning(
                f'publish_rate {self._settings.publish_rate} Hz is not reached: to publish '
                f'everything takes {1e3 * seconds:.0f} ms', throttle_duration_sec=60.0)


async def start_bridge(
    node: Node, frames: PublishedFrames, settings: Settings, loaded: LoadedScene,
    reader: SceneReader, parameter_services: ParameterServices,
) -> None:
    """
    Publish a scene on all other topics, and start the services.

    :param node: the node, with declared parameters and an executor.
    :param frames: the frames of the scene, which are published on ``/tf_static``.
    :param reader: reads files.
    :param parameter_services: the parameter services of the node.
    """
    worker = Worker(node)
    frames = await frames_from_scene(node, worker, loaded, settings, frames)
    await frames.publish_topics()
    SdfPoseBridge(node, frames, settings, loaded, reader, parameter_services, worker)
