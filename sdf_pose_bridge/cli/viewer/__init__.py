# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Show a scene in a browser, by viser; and the meshes in it, by trimesh."""

LIBRARIES = ('viser>=1.1.1,<1.2', 'trimesh>=5.0,<6', 'pycollada>=0.7.2,<0.10')
"""The libraries that only this room needs, in the tested releases; as in setup.py."""


class UntestedViserError(Exception):
    """The installed viser lacks a property of the tested releases; the text names both."""
