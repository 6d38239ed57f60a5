# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The node: keeps what it publishes true to its parameters and to the file."""

from __future__ import annotations

from collections.abc import Sequence
import datetime
import traceback
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.timer import Timer
from std_srvs.srv import Trigger

from sdf_pose_bridge.content import Content
from sdf_pose_bridge.content import content_from_settings
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
        self._watch = FileWatch()
        self._suspicion: list[str] = []
        self._prepared: tuple[Settings, Content | None] | None = None
        self._again: Timer | None = None

    def serve(self, settings: Settings, content: Content) -> None:
        """
        Publish what a file holds, offer services, and follow changes from now on.

        :param settings: what the node is set to do.
        :param content: what it shall serve.
        """
        self._publications = Publications(self)
        self._diagnostics = Diagnostics(self)
        self._take(settings, content)
        add_conversion_services(self)
        logger = self.get_logger()
        self.create_service(
            LookupPose, '~/lookup_pose', never_raising(self._answer_to_lookup, logger))
        self.create_service(Trigger, '~/reload', never_raising(self._answer_to_reload, logger))
        self.add_on_set_parameters_callback(self._judge_parameters)
        self.add_post_set_parameters_callback(self._take_prepared)
        self.create_timer(WATCH_PERIOD_S, self._guarded(self._look_at_files))
        self.create_timer(PERIOD_S, self._guarded(self._diagnose))

    # Changes

    def _take(self, settings: Settings, content: Content) -> None:
        """Serve something else from now on; nothing before this call has changed anything."""
        before = getattr(self, '_state', None)
        transforms = self._publications.publish(content.tree, settings.pose_topics)
        self._settings = settings
        self._lookup = PoseLookup(content.scene, content.tree)
        self._watch.watch(content.files)
        self._suspicion = []
        self._state = State(content, transforms, datetime.datetime.now(datetime.timezone.utc))
        self._publish_again_at(settings.publish_rate)
        logger = self.get_logger()
        for line in lines_from_warnings(content.warnings):
            logger.warning(line)
        if before is not None:
            gone = set(before.content.tree.frame_ids) - set(content.tree.frame_ids)
            if gone:
                logger.warning(
                    f'{_count(len(gone), "frame")} no longer published, which TF listeners keep '
                    f'until they are restarted: {names_in_line(sorted(gone))}')
        logger.info(
            f'publishing {_count(len(content.tree.frame_ids), "frame")} of {content.path} with '
            f'{_count(transforms, "transform")}, root frame "{content.tree.root_frame}" '
            f'(read in {1e3 * content.seconds:.0f} ms)')
        self._diagnose()

    def _reload(self) -> list[str]:
        """Read the file again; return what is wrong with it, which leaves everything as it was."""
        try:
            content = content_from_settings(self._settings)
        except (SdfError, AddressError) as error:
            return lines_from_error(error)
        self._take(self._settings, content)
        return []

    def _report_failure(self, lines: Sequence[str]) -> None:
        if list(lines) != list(self._state.failure):
            self.get_logger().error(
                f'{self._settings.sdf_file} is not taken; what was published before stays')
            for line in lines:
                self.get_logger().error(line)
        self._state = self._state._replace(failure=lines)
        self._diagnose()

    def _look_at_files(self) -> None:
        if not self._settings.watch:
            return
        if self._watch.has_changed():
            self._suspicion = self._reload()
        elif self._suspicion:
            # Half a period later the file is the same, so nobody is about to finish writing it.
            self._report_failure(self._suspicion)
            self._suspicion = []

    def _judge_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        self._prepared = None
        try:
            settings = changed_settings(self, parameters)
            needs_load = settings.file_settings != self._settings.file_settings or any(
                parameter.name == 'sdf_file' for parameter in parameters)
            content = content_from_settings(settings) if needs_load else None
        except (SdfError, SettingsError, AddressError) as error:
            return SetParametersResult(
                successful=False, reason='; '.join(lines_from_error(error)))
        except Exception as error:  # noqa: BLE001 - an exception here would end the node
            self.get_logger().error(f'internal error:\n{traceback.format_exc()}')
            return SetParametersResult(successful=False, reason=f'internal error: {error!r}')
        self._prepared = settings, content
        return SetParametersResult(successful=True)

    def _take_prepared(self, _parameters: list[Parameter]) -> None:
        if self._prepared is not None:
            settings, content = self._prepared
            self._prepared = None
            self._take(settings, self._state.content if content is None else content)

    # What goes on by itself

    def _publish_again_at(self, rate: float) -> None:
        if self._again is not None:
            self.destroy_timer(self._again)
            self._again = None
        if rate:
            self._again = self.create_timer(
                1.0 / rate, self._guarded(self._publications.publish_again))

    def _diagnose(self) -> None:
        self._diagnostics.publish(self._state)

    def _guarded(self, action: Any) -> Any:
        """Keep a defect in what a timer does from ending the node."""
        def callback() -> None:
            try:
                action()
            except Exception:  # noqa: BLE001 - whatever it is, the node lives on
                self.get_logger().error(
                    f'internal error:\n{traceback.format_exc()}', throttle_duration_sec=60.0)
        return callback

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
