# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A service of a simulator that gives poses of entities."""

import re

from geometry_msgs.msg import Point, Pose, Quaternion
from simulation_interfaces.msg import EntityState, Result
from simulation_interfaces.srv import GetEntities, GetEntitiesStates

SIMULATOR = '/gzserver'


class Simulator:
    """
    Answers calls for entities, in another process than the bridge.

    :param entities: the pose of each by its name, x y z and a quaternion x y z w, or x alone.
    """

    def __init__(self, tf, result=Result.RESULT_OK, prefix=SIMULATOR, **entities):
        self.result, self.requests, self.sec, self.entities = result, [], 5000, entities
        node = tf.listener.node
        node.create_service(GetEntitiesStates, f'{prefix}/get_entities_states', self._answer)
        node.create_service(GetEntities, f'{prefix}/get_entities', self._name)

    def _name(self, _request, response):
        response.result.result, response.entities = Result.RESULT_OK, [*self.entities]
        return response

    def _answer(self, request, response):
        self.requests.append(request)
        self.sec += 1
        response.result.result = self.result
        response.result.error_message = f'paused\n[FATAL] at {self.sec}'
        for name, pose in self.entities.items():
            if re.search(request.filters.filter, name):
                x, y, z, *quat = (pose, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0) if (
                    isinstance(pose, float)) else pose
                state = EntityState(pose=Pose(
                    position=Point(x=x, y=y, z=z),
                    orientation=Quaternion(**dict(zip('xyzw', quat, strict=True)))))
                # Isaac Sim names the entity itself.
                state.header.frame_id = name.rpartition('/')[2]
                state.header.stamp.sec = self.sec
                response.entities.append(name)
                response.states.append(state)
        return response
