# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The node: keeps what it publishes true to its parameters and to the file."""

from __future__ import annotations

from collections.abc import Awaitable
from collections.abc import Callable
from collections.abc import Sequence
import contextlib
import datetime
import time
import traceback

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
from sdf_pose_bridge.ros.background import at_once
from sdf_pose_bridge.ros.background import Background
from sdf_pose_bridge.ros.diagnostics import Diagnostics
from sdf_pose_bridge.ros.diagnostics import PERIOD_S
from sdf_pose_bridge.ros.diagnostics import State
from sdf_pose_bridge.ros.file_watcher import FileWatch
from sdf_pose_bridge.ros.file_watcher import Watchman
from sdf_pose_bridge.ros.loaded_scene import Content
from sdf_pose_bridge.ros.loaded_scene import content_from_settings
from sdf_pose_bridge.ros.loaded_scene import files_behind_error
from sdf_pose_bridge.ros.log_lines import lines_from_error
from sdf_pose_bridge.ros.log_lines import lines_from_warnings
from sdf_pose_bridge.ros.log_lines import names_in_line
from sdf_pose_bridge.ros.messages import fill_pose_stamped
from sdf_pose_bridge.ros.parameters import changed_settings
from sdf_pose_bridge.ros.parameters import SettingTogether
from sdf_pose_bridge.ros.publishers import Publications
from sdf_pose_bridge.ros.services import add_conversion_services
from sdf_pose_bridge.ros.services import never_raising
from sdf_pose_bridge.ros.settings import Settings
from sdf_pose_bridge.ros.settings import SettingsError
from sdf_pose_bridge.sdformat.include.uris import AddressError
from sdf_pose_bridge_interfaces.srv import LookupPose


class SdfPoseBridge:
    """
    Everything that a node does; it serves nothing before :meth:`serve`.

    :param node: the node, its parameters declared.
    :param publications: its publishers for frames.
    """

    def __init__(self, node: Node, publications: Publications) -> None:
        self._node = node
        self._publications = publications
        self._background = Background(node)
        # One change after the other, whatever else goes on while a file is read.
        self._changes = MutuallyExclusiveCallbackGroup()
        self._parameter_services = SettingTogether(
            node, self._changes, self._prepare, self._guarded(self._take_judged))
        self._prepared: tuple[Settings, Future] | None = None
        self._judged: tuple[Settings, Content | None] | None = None
        # Simulated time may stand still, and work goes on all the same.
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._again: Timer | None = None
        self._watch = FileWatch()
        self._suspicion: list[str] = []

    def serve(self, settings: Settings, content: Content) -> None:
        """
        Publish what a file holds, offer services, and follow changes from now on.

        :param settings: what the node is set to do.
        :param content: what it shall serve.
        """
        self._settings = settings
        self._diagnostics = Diagnostics(self._node)
        at_once(self._take_content(content))
        self._publish_again_at(settings.publish_rate)
        add_conversion_services(self._node)
        logger = self._node.get_logger()
        self._node.create_service(
            LookupPose, '~/lookup_pose', never_raising(self._answer_to_lookup, logger))
        self._node.create_service(
            Trigger, '~/reload', self._answer_to_reload, callback_group=self._changes)
        self._node.add_on_set_parameters_callback(self._judge_parameters)
        self._node.create_timer(PERIOD_S, self._guarded(self._diagnose), clock=self._steady)
        self._files_may_differ = self._node.create_guard_condition(
            self._guarded(self._look_at_files), callback_group=self._changes)
        self._watchman = Watchman(self._is_to_look_at_files, self._ask_for_look_at_files)

    # Changes

    async def _take_content(self, content: Content) -> None:
        """Serve something else from now on; nothing before this call has changed anything."""
        self._lookup = content.lookup
        self._watch.watch(content.files, content.read_since_ns)
        self._suspicion = []
        transforms = await self._publish(content)
        self._state = State(content, transforms, datetime.datetime.now(datetime.timezone.utc))
        logger = self._node.get_logger()
        for line in lines_from_warnings(content.warnings):
            logger.warning(line)
        logger.info(
            f'publishing {_count(len(content.tree.frame_ids), "frame")} of {content.path} with '
            f'{_count(transforms, "transform")}, root frame "{content.tree.root_frame}" '
            f'(read in {1e3 * content.seconds:.0f} ms)')
        await self._diagnose()

    async def _publish(self, content: Content) -> int:
        outcome = await self._background.all_of(
            self._publications.publish(content.tree, self._settings.pose_topics))
        if outcome.vanished:
            self._node.get_logger().warning(
                f'{_count(len(outcome.vanished), "frame")} no longer published, which TF '
                f'listeners keep until they are restarted: {names_in_line(outcome.vanished)}')
        return outcome.transforms

    def _loading(self, settings: Settings) -> Future:
        return self._background.started(lambda: content_from_settings(settings))

    async def _reload(self) -> list[str]:
        """Read the file again; return what is wrong with it, which leaves everything as it was."""
        try:
            await self._take_content(await self._loading(self._settings))
        except (SdfError, AddressError) as error:
            self._watch.watch_also(files_behind_error(error, self._settings))
            return lines_from_error(error)
        except Exception as error:  # noqa: BLE001 - a defect is told like any other failure
            return [self._internal_error(error)]
        return []

    async def _report_failure(self, lines: Sequence[str]) -> None:
        if list(lines) != list(self._state.failure):
            self._node.get_logger().error(
                f'{self._settings.sdf_file} is not taken; what was published before stays')
            for line in lines:
                self._node.get_logger().error(line)
        self._suspicion = []
        self._state = self._state._replace(failure=lines)
        await self._diagnose()

    def _is_to_look_at_files(self) -> bool:
        return self._settings.watch and (bool(self._suspicion) or self._watch.would_differ())

    def _ask_for_look_at_files(self) -> None:
        # A node that is just being ended asks for nothing any more.
        with contextlib.suppress(InvalidHandle):
            self._files_may_differ.trigger()

    async def _look_at_files(self) -> None:
        try:
            before = self._suspicion
            if self._watch.has_changed():
                self._suspicion = await self._reload()
                is_sure = self._suspicion == before
            else:
                # A period later the files are the same, so nobody is about to finish writing them.
                is_sure = True
            if is_sure and self._suspicion:
                await self._report_failure(self._suspicion)
        finally:
            self._watchman.go_on()

    def _needs_load(self, settings: Settings, parameters: Sequence[Parameter]) -> bool:
        return settings.file_settings != self._settings.file_settings or any(
            parameter.name == 'sdf_file' for parameter in parameters)

    async def _prepare(self, parameters: Sequence[Parameter]) -> None:
        """Read what the parameters name before they are set, which cannot be waited for."""
        self._prepared = None
        try:
            settings = changed_settings(self._node, parameters)
        except SettingsError:
            return
        if self._needs_load(settings, parameters):
            loading = self._loading(settings)
            self._prepared = settings, loading
            # Judging the parameters tells what is wrong.
            with contextlib.suppress(Exception):
                await loading

    def _judge_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        self._judged = None
        prepared, self._prepared = self._prepared, None
        try:
            settings = changed_settings(self._node, parameters)
            if not self._needs_load(settings, parameters):
                content = None
            elif prepared is not None and prepared[0] == settings:
                content = prepared[1].result()
            else:
                content = content_from_settings(settings)
        except (SdfError, SettingsError, AddressError) as error:
            return SetParametersResult(
                successful=False, reason='; '.join(lines_from_error(error)))
        except Exception as error:  # noqa: BLE001 - an exception here would end the node
            return SetParametersResult(successful=False, reason=self._internal_error(error))
        self._judged = settings, content
        return SetParametersResult(successful=True)

    async def _take_judged(self) -> None:
        if self._judged is None:
            return
        before = self._settings
        self._settings, content = self._judged
        self._judged = None
        if content is not None:
            await self._take_content(content)
        elif self._settings.pose_topics != before.pose_topics:
            await self._publish(self._state.content)
        if self._settings.publish_rate != before.publish_rate:
            self._publish_again_at(self._settings.publish_rate)

    # What goes on by itself

    def _publish_again_at(self, rate: float) -> None:
        if self._again is not None:
            self._node.destroy_timer(self._again)
            self._again = None
        if rate:
            self._again = self._node.create_timer(
                1.0 / rate, self._guarded(self._publish_again), callback_group=self._changes,
                clock=self._steady)

    async def _publish_again(self) -> None:
        begin = time.perf_counter()
        await self._background.all_of(self._publications.publish_again())
        seconds = time.perf_counter() - begin
        if seconds * self._settings.publish_rate > 1.0:
            self._node.get_logger().warning(
                f'publish_rate {self._settings.publish_rate} Hz is not reached: to publish '
                f'everything takes {1e3 * seconds:.0f} ms', throttle_duration_sec=60.0)

    async def _diagnose(self) -> None:
        self._diagnostics.publish(self._state)

    def _guarded(self, action: Callable[[], Awaitable[None]]) -> Callable[[], Awaitable[None]]:
        """Keep a defect in what nobody waits for from ending the node."""
        async def callback() -> None:
            try:
                await action()
            except Exception:  # noqa: BLE001 - whatever it is, the node lives on
                self._node.get_logger().error(
                    f'internal error:\n{traceback.format_exc()}', throttle_duration_sec=60.0)
        return callback

    def _internal_error(self, error: Exception) -> str:
        self._node.get_logger().error(f'internal error:\n{traceback.format_exc()}')
        return f'internal error, see the log of the node: {error!r}'

    # Services

    async def _answer_to_reload(
        self, _request: Trigger.Request, response: Trigger.Response,
    ) -> Trigger.Response:
        failure = await self._reload()
        if failure:
            await self._report_failure(failure)
        response.success = not failure
        response.message = '; '.join(failure) or (
            f'publishing {_count(len(self._state.content.tree.frame_ids), "frame")} of '
            f'{self._state.content.path}')
        return response

    def _answer_to_lookup(
        self, request: LookupPose.Request, response: LookupPose.Response,
    ) -> LookupPose.Response:
        try:
            found = self._lookup.pose(request.frame, request.relative_to)
        except SdfError as error:
            response.message = error.message
            return response
        now = self._node.get_clock().now().seconds_nanoseconds()
        fill_pose_stamped(response.pose, found.pose, found.frame_id, now)
        response.success = True
        return response


def _count(number: int, what: str) -> str:
    return f'{number} {what}' if number == 1 else f'{number} {what}s'
