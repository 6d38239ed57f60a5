# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A source of poses of two models, one in the other, and plugins that send odometry of them."""

import re

from sdf_texts import joint, plugin, world_file

from sdf_pose_bridge import load_text
from sdf_pose_bridge.ros.cdr import StampedPose
from sdf_pose_bridge.ros.following.model_poses import messages_from_poses
from sdf_pose_bridge.ros.following.state_messages import KnownStreams, StateSource
from sdf_pose_bridge.ros.publishing.published_frames import PublishedFrames
from sdf_pose_bridge.ros.publishing.publishers import Publishers
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

SHARED = plugin('MecanumDrive', '<odom_topic>shared</odom_topic><frame_id>s</frame_id>')
TEXT = world_file(
    '<model name="a"><link name="l"/><link name="k"/>' + joint(
        '<parent>l</parent><child>k</child><axis><xyz>1 0 0</xyz></axis>', 'j', 'prismatic')
    + plugin('DiffDrive', '<odom_topic>wheels</odom_topic><frame_id>o</frame_id>')
    + plugin('OdometryPublisher', '<odom_frame>o</odom_frame><xyz_offset>0 -1 0</xyz_offset>')
    + SHARED
    # It moves with the link k of the model a.
    + '<model name="c"><pose>4 0 0 0 0 0</pose><link name="l"/>'
    + plugin('DiffDrive', '<frame_id>of_c</frame_id>') + '</model>'
    + joint('<parent>k</parent><child>c::l</child>', 'w', 'fixed')
    + '<model name="b"><pose>0 3 0 0 0 0</pose><link name="l"/>'
    + plugin('DiffDrive') + SHARED + '</model></model>'
    '<model name="fixed"><static>true</static><pose>0 2 0 0 0 0</pose><link name="l"/></model>')
POSE = (1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0)


class Models:
    """A source of poses of the models ``a`` and ``a::b``."""

    def __init__(self, node, placement='', text=TEXT):
        scene = load_text(text, plugins=True)
        tree = tf_tree_from_scene(scene, TfOptions(
            use_joint_states=True, follows_models=True, frame_prefix='p/'))
        self.positions = JointPositions(scene, tree.moving.motion)
        self.frames = PublishedFrames(Publishers(node), tree, self.positions, {}).moving
        self.streams = KnownStreams(
            self.frames, PoseLookup(scene, tree, self.positions), [re.compile('.*/odom')],
            placement)
        self.source = StateSource(node, '/poses')

    def read(self, child='a', frame_id='', pose=POSE, stamp_ns=5, model=None):
        """Return the messages of a pose, for a model or for the one that the child names."""
        dof = None if model is None else self.streams.models[model]
        return messages_from_poses(
            [StampedPose(stamp_ns, frame_id, child, pose)], self.source, self.streams, dof,
            self.streams.placements)

    def moved(self, **fields):
        """Return the name of the model that a pose moves, and its x and y in the root."""
        (message,) = self.read(**fields)
        (dof,) = message.stream.selection.dofs
        return self.positions.names[dof], *self.streams.values(message)[0, :2].tolist()
