# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Measure how fast the package is, each time against something measured in the same run.

``python -m benchmarks`` runs every benchmark of the modules ``bench_*`` in this package.
"""
