# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The names of formats that are nearest to an unknown one, for messages."""

from __future__ import annotations

from collections.abc import Mapping
import difflib
import re

_LONGEST_NAME, _MOST_NAMES = 40, 3
"""Of a name that is compared with those of formats, and of the nearest ones in a message."""

_ORDER_OR_UNIT = re.compile('[wxyz]{3,4}|rpy|ypr|row|col|deg|rad|mm')


def near_formats(wanted: str, names: Mapping[str, str]) -> str:
    """
    Return a part of a message with the nearest names, none of another order, unit or maker.

    :param names: the format of each name and synonym.
    """
    wanted = wanted.lower()[:_LONGEST_NAME]
    orders_and_units = _ORDER_OR_UNIT.findall(wanted)
    makers = {*wanted.split('_')} & {name.split('_')[0] for name in names}
    alike = [name for name in names if makers <= {*name.split('_')} and all(
        any(each.startswith(part) for each in _ORDER_OR_UNIT.findall(name))
        for part in orders_and_units)]
    near = [name for name in alike if makers or wanted in name]
    near += difflib.get_close_matches(wanted, alike)
    if not near and (makers or orders_and_units):
        return ''
    shown: dict[str, str] = {}
    for name in near or alike:
        shown.setdefault(names[name], name)
    return f'{"near" if near else "some"}: {", ".join([*shown.values()][:_MOST_NAMES])}; '
