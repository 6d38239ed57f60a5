# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The node: publishes a file, and follows changes of its parameters and of the file.

One thread, the loader, does one request after the other, and between them what is due. The
executor of the node only answers: it hands requests to the loader and awaits their results.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
import math
import time
from typing import Any, TYPE_CHECKING

from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import String
from std_srvs.srv import Trigger

from sdf_pose_bridge.errors import AddressError, SdfError
from sdf_pose_bridge.export.published_scene import LoadedScene, LoadRequest
from sdf_pose_bridge.export.scene_from_request import files_behind_error
from sdf_pose_bridge.problems import by_message
from sdf_pose_bridge.ros.background import Periodic, result_from_executor, Worker
from sdf_pose_bridge.ros.file_process import FileProcess, loaded_scene
from sdf_pose_bridge.ros.following.other_publishers import OtherPublishers, OTHERS_PERIOD_S
from sdf_pose_bridge.ros.log_lines import (
    line_about_frames,
    line_about_rest,
    line_from_text,
    lines_about_lost_frames,
    lines_about_scene,
    lines_from_error,
    lines_from_warnings,
    text_about_defect,
)
from sdf_pose_bridge.ros.node.file_follower import FileFollower
from sdf_pose_bridge.ros.node.services import add_service, add_services, set_pose
from sdf_pose_bridge.ros.parameters.declarations import Settings, SettingsError
from sdf_pose_bridge.ros.parameters.given import changed_settings, ParameterServices
from sdf_pose_bridge.ros.publishing import topic_names
from sdf_pose_bridge.ros.publishing.diagnostics import Diagnostics, PERIOD_S
from sdf_pose_bridge.ros.publishing.published_frames import frames_from_scene, PublishedFrames
from sdf_pose_bridge.ros.publishing.publishers import SwitchedPublisher, Topic
from sdf_pose_bridge.ros.publishing.state_report import StateReport
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge_interfaces.srv import SetPose

if TYPE_CHECKING:
    from sdf_pose_bridge.ros.following.joint_states import JointStates

LOOKING_PERIOD_S = 0.25
"""Seconds between two looks at the files."""

LARGEST_SHARE = 0.001
"""Largest share of a core for looking at them; if that takes long, the period gets longer."""

ENTITIES_PERIOD_S = 1.0
"""Shortest period in s of a load because of entities that only the simulator has."""

ALWAYS_LOADED = (
    'sdf_file', 'robot_description', 'model_pose_topics', 'model_pose_frames',
    'model_pose_placement', 'simulator')
"""Parameters with which the file is read again even if the request for the load stays."""

LONGEST_WAIT_S = 0.1
"""Longest time in s for which a call in another process is awaited at once."""


class SdfPoseBridge:
    """
    The node from the moment at which its fixed frames are on ``/tf_static``.

    The loader constructs it and calls all methods but those of the executor. The constructor
    publishes everything else and starts the services. A failure in the middle of a change ends the
    process, because other threads would go on with half of it.

    :param node: the node, with declared parameters and an executor in another thread.
    :param loader: the thread.
    :param frames: the frames of the scene, which are published on ``/tf_static``.
    :param reader: reads files.
    :param parameter_services: the parameter services of the node; they begin to answer.
    """

    def __init__(
        self, node: Node, loader: Worker, frames: PublishedFrames, settings: Settings,
        loaded: LoadedScene, reader: FileProcess, parameter_services: ParameterServices,
    ) -> None:
        self._node = node
        self._logger = node.get_logger()
        self._loader = loader
        self._frames = frames
        self._settings = settings
        self._loaded = loaded
        self._reader = reader
        self._entities: tuple[str, ...] = ()
        self._joint_states: JointStates | None = None
        self._diagnostics = Diagnostics(node, self._state_report)
        self._others = OtherPublishers(node)
        self._follower = FileFollower(loaded)
        # Simulated time may stand still, so these follow the time of the computer.
        self._publishing_again = self._periodic_publication(settings)
        self._publishing_diagnostics = Periodic(self._diagnostics.publish, PERIOD_S)
        self._looking = Periodic(self._look_at_files, LOOKING_PERIOD_S)
        self._looking_for_others = Periodic(
            lambda: self._others.look(self._frames, self._loaded.scene), OTHERS_PERIOD_S)
        self._following_entities = Periodic(self._follow_entities, ENTITIES_PERIOD_S)
        self._publish(loaded, self._frames_from_scene(loaded, settings))
        result_from_executor(node, lambda: self._start_services(parameter_services))
        self._report_success()
        # Imported here because it is slow to import, and everything else is more urgent.
        from sdf_pose_bridge.ros.publishing.visuals import VisualPublisher
        # With the quality of service that it has in robot_state_publisher.
        self._robot_description = SwitchedPublisher(node, Topic('robot_description', String))
        self._publish_robot_description()
        self._visuals = VisualPublisher(node, reader, loaded)
        self._follow_switches()
        loader.between = self._do_what_is_due

    # What the executor does

    def _start_services(self, parameter_services: ParameterServices) -> None:
        add_services(self._node, self._current_lookup)
        # Like those for parameters, they are taken from the middleware one after the other.
        group = parameter_services.group
        add_service(self._node, Trigger, 'reload', self._answer_to_reload, group)
        if self._settings.allow_set_pose:
            add_service(self._node, SetPose, 'set_pose', self._answer_to_set_pose, group)
        parameter_services.start(
            lambda parameters: self._loader.run(lambda: self._set_parameters(parameters)))

    async def _answer_to_reload(
        self, _request: Trigger.Request, response: Trigger.Response,
    ) -> Trigger.Response:
        return await self._loader.run(lambda: self._reload_as_requested(response))

    async def _answer_to_set_pose(
        self, request: SetPose.Request, _response: SetPose.Response,
    ) -> SetPose.Response:
        return await self._loader.run(lambda: self._set_pose(request))

    async def _current_lookup(self) -> PoseLookup:
        if self._joint_states is None:
            return self._loaded.lookup
        lookup: PoseLookup = await self._joint_states.current_lookup()
        return lookup

    # Requests, one after the other

    def _reload_as_requested(self, response: Trigger.Response) -> Trigger.Response:
        failure = self._reload()
        self._report_failure(self._follower.unreported(failure))
        response.success = not failure
        response.message = '; '.join(failure) or line_about_frames(self._loaded)
        return response

    def _set_pose(self, request: SetPose.Request) -> SetPose.Response:
        """Write a measured pose, and respond when it is published."""
        if self._joint_states is not None:
            self._joint_states.wait()
        try:
            response: SetPose.Response = set_pose(request, self._loaded, self._result)
            if not request.dry_run:
                self._logger.info(line_from_text(
                    f'wrote the pose of "{request.frame}" to {response.file}:{response.line}'))
                loaded = self._load(self._settings)
                frames = self._frames_from_scene(loaded, self._settings)
        except Exception as error:  # noqa: BLE001 - the client must be answered
            return SetPose.Response(message='; '.join(self._lines_from_error(error)))
        if not request.dry_run:
            self._replace(loaded, frames)
        return response

    def _set_parameters(self, parameters: Sequence[Parameter]) -> SetParametersResult:
        """Set parameters if all settings, and the file that they name, are valid."""
        frames = None
        try:
            settings = changed_settings(self._settings, parameters)
            loaded = self._loaded
            if settings.load_request != self._settings.load_request or any(
                    parameter.name in ALWAYS_LOADED for parameter in parameters):
                loaded = self._load(settings)
            topic_names.check_number_of_topics(settings, loaded.joint_positions)
            if loaded is not self._loaded or (
                    settings.pose_topics, settings.publish_transforms) != (
                        self._settings.pose_topics, self._settings.publish_transforms):
                frames = self._frames_from_scene(loaded, settings)
            result: SetParametersResult = result_from_executor(
                self._node, lambda: self._node.set_parameters_atomically(parameters))
        except Exception as error:  # noqa: BLE001 - the client must be answered
            reason = '; '.join(self._lines_from_error(error))
            result = SetParametersResult(successful=False, reason=reason)
        if result.successful:
            self._apply(settings, loaded, frames)
        elif frames is not None:
            self._frames.destroy_other_publishers()
        return result

    # What is done between requests

    def _do_what_is_due(self) -> float:
        """Return the longest time in s until this has to be called again."""
        return min(
            self._publish_what_is_due(), self._looking.call_if_due(),
            self._following_entities.call_if_due(), self._visuals.go_on())

    def _publish_what_is_due(self) -> float:
        """Do what is due also during a load; return the time in s until there is more."""
        return min(
            self._publishing_again.call_if_due(), self._publishing_diagnostics.call_if_due(),
            self._looking_for_others.call_if_due())

    def _look_at_files(self) -> None:
        if not self._settings.watch:
            return
        # Waiting for a disk or a core must not lengthen the period.
        begin = time.thread_time()
        has_to_read = self._follower.has_to_read()
        self._looking.period_s = max(
            LOOKING_PERIOD_S, (time.thread_time() - begin) / LARGEST_SHARE)
        self._report_failure(
            self._follower.failure_of_period(self._reload() if has_to_read else None))

    def _follow_entities(self) -> None:
        """Load the scene with frames of the entities that are in the simulator alone."""
        simulator = self._joint_states and self._joint_states.sources.simulator
        others = simulator.others if simulator and self._settings.simulator_others else ()
        if others != self._entities:
            begin = time.monotonic()
            self._entities = others
            self._report_failure(self._follower.unreported(self._reload()))
            self._following_entities.period_s = max(
                ENTITIES_PERIOD_S, 10.0 * (time.monotonic() - begin))

    def _periodic_publication(self, settings: Settings) -> Periodic:
        rate = settings.publish_rate
        return Periodic(self._publish_again, 1.0 / rate if rate else math.inf)

    def _publish_again(self) -> None:
        begin = time.perf_counter()
        self._frames.publish_fixed_again()
        seconds = time.perf_counter() - begin
        if seconds * self._settings.publish_rate > 1.0:
            self._logger.warning(
                f'publish_rate {self._settings.publish_rate} Hz is not reached: to publish '
                f'everything takes {1e3 * seconds:.0f} ms', throttle_duration_sec=60.0)

    # Loading

    def _reload(self) -> list[str]:
        """Read the files again; return the errors, after which nothing has changed."""
        try:
            loaded = self._load(self._settings)
            frames = self._frames_from_scene(loaded, self._settings)
        except Exception as error:  # noqa: BLE001 - includes defects
            lines, request = self._lines_from_error(error), self._settings.load_request
            self._follower.follow_error(error, files_behind_error(error, request))
            return lines
        self._replace(loaded, frames)
        return []

    def _load(self, settings: Settings) -> LoadedScene:
        options = settings.tf_options._replace(others=self._entities)
        request = settings.load_request._replace(tf_options=options)
        loaded: LoadedScene = self._result(request, loaded_scene, request)
        return loaded

    def _result(
        self, request: LoadRequest, function: Callable[..., Any], *arguments: object,
    ) -> Any:
        """Call a function that reads files in another process, and do meanwhile what is due."""
        with self._reader.calling(request, function, *arguments) as call:
            while not call.has_ended(min(LONGEST_WAIT_S, self._publish_what_is_due())):
                if self._loader.has_to_end:
                    raise SystemExit
            return call.result()

    def _frames_from_scene(self, loaded: LoadedScene, settings: Settings) -> PublishedFrames:
        """Make the messages and publishers of a scene. Whatever can fail is done here."""
        topic_names.check_number_of_topics(settings, loaded.joint_positions)
        return frames_from_scene(self._node, loaded, settings, self._frames)

    def _lines_from_error(self, error: Exception) -> list[str]:
        if isinstance(error, MemoryError):
            raise error
        if isinstance(error, SdfError | SettingsError | AddressError):
            return lines_from_error(error)
        self._logger.error(text_about_defect('a request'))
        return [f'internal error, see the log of the node: {error!r}']

    # Publishing

    def _publish(self, loaded: LoadedScene, frames: PublishedFrames) -> None:
        """Publish prepared frames on all topics instead of those before."""
        is_new = loaded is not self._loaded
        self._loaded, self._frames = loaded, frames
        self._follow_joints()
        # From then on, nothing publishes the frames before.
        if is_new:
            frames.publish_tf_static()
        frames.destroy_other_publishers()
        frames.publish_topics()
        if self._joint_states is not None:
            self._joint_states.publish_topics()

    def _follow_joints(self) -> None:
        """Subscribe to joint states if moving frames follow them."""
        settings, moving, current = self._settings, self._frames.moving, self._joint_states
        if moving is None:
            if current is not None:
                result_from_executor(self._node, self._end_joint_states)
            return
        topics = topic_names.state_topics_from_settings(
            settings, self._loaded.tree, moving.positions, self._node.resolve_topic_name)
        # Imported here because it takes 8 ms, and joints do not move by default.
        from sdf_pose_bridge.ros.following.joint_states import JointStates
        if current is not None:
            current.follow(moving, self._loaded.lookup, topics, settings)
        else:
            self._joint_states = JointStates(
                self._node, moving, self._loaded.lookup, topics, settings)

    def _end_joint_states(self) -> None:
        # The executor does this, so that no look-up waits for the thread after its end.
        if self._joint_states is not None:
            self._joint_states.end()
            self._joint_states = None

    def _replace(self, loaded: LoadedScene, frames: PublishedFrames) -> None:
        """Publish prepared frames, and whatever else belongs to the scene if that is new."""
        before = self._loaded
        self._publish(loaded, frames)
        if loaded is not before:
            self._follower.follow(loaded)
            for line in lines_about_lost_frames(before.tree, loaded.tree):
                self._logger.warning(line)
            self._report_success()
            self._publish_robot_description()
            self._visuals.replace(loaded)

    def _apply(
        self, settings: Settings, loaded: LoadedScene, frames: PublishedFrames | None,
    ) -> None:
        before, self._settings = self._settings, settings
        if settings.publish_rate != before.publish_rate:
            self._publishing_again = self._periodic_publication(settings)
        if frames is not None:
            self._replace(loaded, frames)
        else:
            self._follow_joints()
        self._follow_switches()
        if settings.publish_robot_description != before.publish_robot_description:
            self._publish_robot_description()

    def _follow_switches(self) -> None:
        self._diagnostics.switch(on=self._settings.publish_diagnostics)
        self._visuals.switch(on=self._settings.publish_visuals)

    def _publish_robot_description(self) -> None:
        text = self._loaded.description if self._settings.publish_robot_description else ''
        self._robot_description.switch(on=bool(text))
        self._robot_description.publish(String(data=text))

    # Reporting

    def _state_report(self) -> StateReport:
        found = StateReport() if self._joint_states is None else self._joint_states.report()
        return found._replace(problems=[*found.problems, *self._others.problems.values()])

    def _report_success(self) -> None:
        loaded = self._loaded
        for line in lines_from_warnings([
                f'{each}{other_lines}' for each, other_lines in by_message(loaded.warnings)]):
            self._logger.warning(line)
        for line in lines_about_scene(loaded):
            self._logger.info(line)
        if line := line_about_rest(loaded.tree):
            self._logger.info(line, once=True)
        self._diagnostics.update(loaded)

    def _report_failure(self, lines: list[str]) -> None:
        if lines:
            source = self._settings.load_request.source
            self._logger.error(
                f'{line_from_text(source)} is rejected; the frames published before stay')
            for line in lines:
                self._logger.error(line)
            self._diagnostics.update(self._loaded, lines)
