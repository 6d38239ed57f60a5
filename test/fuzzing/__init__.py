# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Coverage-guided fuzzing of the loading of files; needs atheris, which ``make fuzz`` installs."""
