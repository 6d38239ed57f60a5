// Copyright 2026 The sdf_pose_bridge authors
// SPDX-License-Identifier: Apache-2.0
//
// Subscribes to the pose of a frame. When the pose arrives or changes, asks the bridge for the pose
// relative to another frame, and converts its rotation. python_client.py does the same in Python.
// To build and run it, copy this folder into a workspace, where colcon shall not ignore it:
//
//     cp -r examples/cpp_client ~/ws/src && rm ~/ws/src/cpp_client/*_IGNORE && cd ~/ws
//     colcon build && . install/setup.bash
//     ros2 run sdf_pose_bridge bridge --ros-args -p sdf_file:=examples/work_cell.sdf &
//     ros2 run sdf_pose_bridge_cpp_client client --ros-args -p frame:=fixture

#include <chrono>
#include <memory>
#include <string>

#include "geometry_msgs/msg/pose_stamped.hpp"
#include "rclcpp/rclcpp.hpp"
#include "sdf_pose_bridge_interfaces/srv/convert_rotation.hpp"
#include "sdf_pose_bridge_interfaces/srv/lookup_pose.hpp"

using geometry_msgs::msg::PoseStamped;
using geometry_msgs::msg::Quaternion;
using sdf_pose_bridge_interfaces::srv::ConvertRotation;
using sdf_pose_bridge_interfaces::srv::LookupPose;

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  const auto node = std::make_shared<rclcpp::Node>("cpp_client");
  const auto logger = node->get_logger();
  const auto frame = node->declare_parameter<std::string>("frame", "robot/tool0");
  const auto relative_to = node->declare_parameter<std::string>("relative_to", "table");
  const auto bridge = node->declare_parameter<std::string>("bridge", "/sdf_pose_bridge");

  const auto lookup_pose = node->create_client<LookupPose>(bridge + "/lookup_pose");
  const auto convert_rotation = node->create_client<ConvertRotation>(bridge + "/convert_rotation");
  // A request that is sent before the service is found gets no response.
  const auto second = std::chrono::seconds(1);
  while (!lookup_pose->wait_for_service(second) || !convert_rotation->wait_for_service(second)) {
    if (!rclcpp::ok()) {return 0;}  // Ctrl-C
    RCLCPP_INFO(logger, "waiting for the services of %s", bridge.c_str());
  }

  const auto log_position = [&](const PoseStamped & pose) {
      const auto & xyz = pose.pose.position;
      RCLCPP_INFO(
        logger, "%s in %s: xyz %.4f %.4f %.4f m", frame.c_str(), pose.header.frame_id.c_str(),
        xyz.x, xyz.y, xyz.z);
    };

  // The response of a service comes to a callback. Waiting for it in another callback would block
  // the executor, which has to receive it.
  const auto convert = [&](const Quaternion & quaternion) {
      auto request = std::make_shared<ConvertRotation::Request>();
      request->given = ConvertRotation::Request::QUATERNION;
      request->quaternion = quaternion;
      request->degrees = true;
      convert_rotation->async_send_request(
        request, [&](rclcpp::Client<ConvertRotation>::SharedFuture future) {
          const auto & rpy = future.get()->rpy;
          RCLCPP_INFO(logger, "roll pitch yaw: %.2f %.2f %.2f degrees", rpy.x, rpy.y, rpy.z);
        });
    };

  const auto look_up = [&]() {
      auto request = std::make_shared<LookupPose::Request>();
      request->frame = frame;
      request->relative_to = relative_to;
      lookup_pose->async_send_request(
        request, [&](rclcpp::Client<LookupPose>::SharedFuture future) {
          const auto response = future.get();
          if (!response->success) {  // a name that the file does not have; the message says which
            RCLCPP_ERROR(logger, "%s", response->message.c_str());
            return;
          }
          log_position(response->pose);
          convert(response->pose.pose.orientation);
        });
    };

  // A pose is published once, and again when it changes or the file is read again. A transient
  // local subscription gets the last message even if it starts later; a volatile one, which is the
  // default, would miss it.
  // A topic name has letters, digits, "_" and "/"; other characters of a frame id are escaped:
  // the pose of "left cam" is on ~/poses/left_x20_cam.
  const auto subscription = node->create_subscription<PoseStamped>(
    bridge + "/poses/" + frame, rclcpp::QoS(1).reliable().transient_local(),
    [&](const PoseStamped & pose) {
      log_position(pose);
      look_up();
    });

  rclcpp::spin(node);
  rclcpp::shutdown();
}
