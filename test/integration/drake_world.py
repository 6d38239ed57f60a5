# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Simulate a world with Drake: ``drake_world.py FILE``, with the Python of Drake.

For each time in seconds on the standard input, print a line of JSON with the poses of models and
links by their scoped names, x y z and a quaternion x y z w, and the positions of joints.
"""

import json
import sys

from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
from pydrake.multibody.tree import ModelInstanceIndex
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder


def numbers(pose):
    """Return x y z and a quaternion x y z w."""
    quat = pose.rotation().ToQuaternion()
    return [*pose.translation().tolist(), quat.x(), quat.y(), quat.z(), quat.w()]


def main():
    """Simulate until the standard input ends."""
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, time_step=0.001)
    Parser(plant).AddModels(sys.argv[1])
    plant.Finalize()
    simulator = Simulator(builder.Build())
    context = plant.GetMyContextFromRoot(simulator.get_context())
    # The first two instances are the world and what is in no model.
    instances = [ModelInstanceIndex(each) for each in range(2, plant.num_model_instances())]
    names = {each: plant.GetModelInstanceName(each) for each in instances}
    for line in sys.stdin:
        simulator.AdvanceTo(float(line))
        bodies = [
            (each, plant.get_body(body)) for each in instances
            for body in plant.GetBodyIndices(each)]
        joints = [plant.get_joint(joint) for each in instances
                  for joint in plant.GetJointIndices(each)]
        print(json.dumps({
            'models': {
                names[each]: numbers(
                    plant.GetFrameByName('__model__', each).CalcPoseInWorld(context))
                for each in instances},
            'links': {
                f'{names[each]}::{body.name()}': numbers(plant.EvalBodyPoseInWorld(context, body))
                for each, body in bodies},
            'joints': {
                joint.name(): joint.GetOnePosition(context)
                for joint in joints if joint.num_positions() == 1},
        }), flush=True)


if __name__ == '__main__':
    main()
