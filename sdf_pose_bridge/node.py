# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The node: keeps what it publishes true to its parameters and to the file."""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Sequence
import datetime
import time
import traceback
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock
from rclpy.clock import ClockType
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.timer import Timer
from std_srvs.srv import Trigger

from sdf_pose_bridge.content import Content
from sdf_pose_bridge.content import files_behind_error
from sdf_pose_bridge.conversion_services import add_conversion_services
from sdf_pose_bridge.conversion_services import never_raising
from sdf_pose_bridge.diagnostics import Diagnostics
from sdf_pose_bridge.diagnostics import PERIOD_S
from sdf_pose_bridge.diagnostics import State
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.file_address import AddressError
from sdf_pose_bridge.file_watch import FileWatch
from sdf_pose_bridge.log_lines import lines_from_error
from sdf_pose_bridge.log_lines import lines_from_warnings
from sdf_pose_bridge.log_lines import names_in_line
from sdf_pose_bridge.lookup import PoseLookup
from sdf_pose_bridge.messages import pose_stamped
from sdf_pose_bridge.parameters import changed_settings
from sdf_pose_bridge.parameters import SettingTogether
from sdf_pose_bridge.publications import Publications
from sdf_pose_bridge.settings import Settings
from sdf_pose_bridge.settings import SettingsError
from sdf_pose_bridge_interfaces.srv import LookupPose

NODE_NAME = 'sdf_pose_bridge'

WATCH_PERIOD_S = 0.5
"""Seconds between two looks at the files."""


class SdfPoseBridge(Node):
    """The node; it serves nothing before :meth:`serve`."""

    def __init__(self) -> None:
        super().__init__(NODE_NAME, start_parameter_services=False)
        self._parameter_services = SettingTogether(self)
        # Simulated time may stand still, and files change all the same.
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._watch = FileWatch()
        self._suspicion: list[str] = []
        self._prepared: tuple[Settings, Content | None] | None = None
        self._again: Timer | None = None

    def serve(
        self, settings: Settings, content: Content, load: Callable[[Settings], Content],
    ) -> None:
        """
        Publish what a file holds, offer services, and follow changes from now on.

        :param settings: what the node is set to do.
        :param content: what it shall serve.
        :param load: reads the file again; it raises what
            :func:`~sdf_pose_bridge.content.content_from_settings` does.
        """
        self._load = load
        self._settings = settings
        self._publications = Publications(self)
        self._diagnostics = Diagnostics(self)
        self._take_content(content)
        self._publish_again_at(settings.publish_rate)
        add_conversion_services(self)
        logger = self.get_logger()
        self.create_service(
            LookupPose, '~/lookup_pose', never_raising(self._answer_to_lookup, logger))
        self.create_service(Trigger, '~/reload', never_raising(self._answer_to_reload, logger))
        self.add_on_set_parameters_callback(self._judge_parameters)
        self.add_post_set_parameters_callback(self._guarded(self._take_prepared))
        self._every(WATCH_PERIOD_S, self._look_at_files)
        self._every(PERIOD_S, self._diagnose)

    # Changes

    def _take_content(self, content: Content) -> None:
        """Serve something else from now on; nothing before this call has changed anything."""
        lookup = PoseLookup(content.scene, content.tree)
        transforms = self._publish(content)
        self._lookup = lookup
        self._watch.watch(content.files, content.read_since_ns)
        self._suspicion = []
        self._state = State(content, transforms, datetime.datetime.now(datetime.timezone.utc))
        logger = self.get_logger()
        for line in lines_from_warnings(content.warnings):
            logger.warning(line)
        logger.info(
            f'publishing {_count(len(content.tree.frame_ids), "frame")} of {content.path} with '
            f'{_count(transforms, "transform")}, root frame "{content.tree.root_frame}" '
            f'(read in {1e3 * content.seconds:.0f} ms)')
        self._diagnose()

    def _publish(self, content: Content) -> int:
        outcome = self._publications.publish(content.tree, self._settings.pose_topics)
        if outcome.vanished:
            self.get_logger().warning(
                f'{_count(len(outcome.vanished), "frame")} no longer published, which TF '
                f'listeners keep until they are restarted: {names_in_line(outcome.vanished)}')
        return outcome.transforms

    def _reload(self) -> list[str]:
        """Read the file again; return what is wrong with it, which leaves everything as it was."""
        try:
            content = self._load(self._settings)
        except (SdfError, AddressError) as error:
            self._watch.watch_also(files_behind_error(error, self._settings))
            return lines_from_error(error)
        except Exception as error:  # noqa: BLE001 - a defect is told like any other failure
            return [self._internal_error(error)]
        self._take_content(content)
        return []

    def _report_failure(self, lines: Sequence[str]) -> None:
        if list(lines) != list(self._state.failure):
            self.get_logger().error(
                f'{self._settings.sdf_file} is not taken; what was published before stays')
            for line in lines:
                self.get_logger().error(line)
        self._suspicion = []
        self._state = self._state._replace(failure=lines)
        self._diagnose()

    def _look_at_files(self) -> None:
        if not self._settings.watch:
            return
        before = self._suspicion
        if self._watch.has_changed():
            self._suspicion = self._reload()
            is_sure = self._suspicion == before
        else:
            # A period later the files are the same, so nobody is about to finish writing them.
            is_sure = True
        if is_sure and self._suspicion:
            self._report_failure(self._suspicion)

    def _judge_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        self._prepared = None
        try:
            settings = changed_settings(self, parameters)
            needs_load = settings.file_settings != self._settings.file_settings or any(
                parameter.name == 'sdf_file' for parameter in parameters)
            content = self._load(settings) if needs_load else None
        except (SdfError, SettingsError, AddressError) as error:
            return SetParametersResult(
                successful=False, reason='; '.join(lines_from_error(error)))
        except Exception as error:  # noqa: BLE001 - an exception here would end the node
            return SetParametersResult(successful=False, reason=self._internal_error(error))
        self._prepared = settings, content
        return SetParametersResult(successful=True)

    def _take_prepared(self, _parameters: list[Parameter]) -> None:
        if self._prepared is None:
            return
        before = self._settings
        self._settings, content = self._prepared
        self._prepared = None
        if content is not None:
            self._take_content(content)
        elif self._settings.pose_topics != before.pose_topics:
            self._publish(self._state.content)
        if self._settings.publish_rate != before.publish_rate:
            self._publish_again_at(self._settings.publish_rate)

    # What goes on by itself

    def _publish_again_at(self, rate: float) -> None:
        if self._again is not None:
            self.destroy_timer(self._again)
            self._again = None
        if rate:
            self._again = self._every(1.0 / rate, self._publish_again)

    def _publish_again(self) -> None:
        begin = time.perf_counter()
        self._publications.publish_again()
        seconds = time.perf_counter() - begin
        if seconds * self._settings.publish_rate > 1.0:
            self.get_logger().warning(
                f'publish_rate {self._settings.publish_rate} Hz is not reached: to publish '
                f'everything takes {1e3 * seconds:.0f} ms', throttle_duration_sec=60.0)

    def _diagnose(self) -> None:
        self._diagnostics.publish(self._state)

    def _every(self, seconds: float, action: Callable[[], None]) -> Timer:
        return self.create_timer(seconds, self._guarded(action), clock=self._steady)

    def _guarded(self, action: Callable[..., None]) -> Callable[..., None]:
        """Keep a defect in what nobody waits for from ending the node."""
        def callback(*arguments: Any) -> None:
            try:
                action(*arguments)
            except Exception:  # noqa: BLE001 - whatever it is, the node lives on
                self.get_logger().error(
                    f'internal error:\n{traceback.format_exc()}', throttle_duration_sec=60.0)
        return callback

    def _internal_error(self, error: Exception) -> str:
        self.get_logger().error(f'internal error:\n{traceback.format_exc()}')
        return f'internal error, see the log of the node: {error!r}'

    # Services

    def _answer_to_reload(
        self, _request: Trigger.Request, response: Trigger.Response,
    ) -> Trigger.Response:
        failure = self._reload()
        if failure:
            self._report_failure(failure)
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
        response.pose = pose_stamped(found.pose, found.frame_id, self.get_clock().now().to_msg())
        response.success = True
        return response


def _count(number: int, what: str) -> str:
    return f'{number} {what}' if number == 1 else f'{number} {what}s'
