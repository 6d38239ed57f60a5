# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Compare the package with libsdformat 14 or later on random scenes.

Scenes avoid what libsdformat gets wrong:

* in URDF: one of the characters ``"'&<`` in the name of a fixed joint or of its child, and a
  number out of range in the ``<origin>`` of a robot, on both of which it crashes; a tab between
  numbers, which separates nothing there;
* version 1.12, which release 14 refuses, though its poses are those of 1.11;
* a quaternion of another length than one, which is not normalized;
* a bare ``&`` after a character reference in one value, which becomes another character;
* a name with ``::`` in files of version 1.7 and before, outside a family of its own: models are
  made of such names by a rule that also takes names that only begin alike;
* a static model without links as the first nested model of a model without links: the outer model
  then has no canonical link.
"""
