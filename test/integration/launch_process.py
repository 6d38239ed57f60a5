# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Run a launch file until a signal ends it, as ``ros2 launch`` does: FILE [NAME:=VALUE ...].

It is a program because the launch service needs the main thread and its signals.
"""

import sys

from launch import LaunchDescription, LaunchService
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import AnyLaunchDescriptionSource


def main():
    file, *words = sys.argv[1:]
    service = LaunchService()
    service.include_launch_description(LaunchDescription([IncludeLaunchDescription(
        AnyLaunchDescriptionSource(file),
        launch_arguments=[tuple(word.split(':=', 1)) for word in words])]))
    return service.run()


if __name__ == '__main__':
    sys.exit(main())
