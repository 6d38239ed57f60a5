# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``~/visuals`` of a running bridge, received by another process."""

from changes import BRIDGE, reload, replace, set_parameters
from listener import latched
import pytest
from slow_file import SlowFile
from visualization_msgs.msg import Marker, MarkerArray


def crate(*visuals):
    """Return a file with a crate that has visuals of these names and shapes."""
    children = ''.join(
        f'<visual name="{name}"><pose>0 0 1 0 0 0</pose><geometry>{shape}</geometry></visual>'
        for name, shape in visuals)
    return f"""<sdf version="1.10"><world name="w">
  <model name="crate"><pose>5 0 0 0 0 0</pose><link name="body">{children}</link></model>
</world></sdf>"""


BOX = ('side', '<box><size>1 2 3</size></box>')
BALL = ('ball', '<sphere><radius>2</radius></sphere>')
FILE_TEXT = crate(BOX)


@pytest.fixture
def listener(bridge, start_listener):
    """A listener beside a bridge that does not notice changes."""
    listener = start_listener()
    set_parameters(listener, watch=False)
    return listener


def arrays_of(listener):
    arrays = []
    listener.node.create_subscription(
        MarkerArray, f'{BRIDGE}/visuals', arrays.append, latched(1))
    return arrays


def wait_for_types(listener, arrays, *types):
    """Wait for an array with markers of these types after the one that deletes all; return it."""
    def last():
        return [each.type for each in arrays[-1].markers[1:]] if arrays else None

    listener.wait(lambda: last() == list(types), lambda: f'{types}; last was {last()}')
    return arrays[-1]


def test_each_listener_gets_the_visuals_of_the_published_file_until_a_reload(
        listener, file, start_listener):
    replace(file, crate(BALL))
    arrays = arrays_of(listener)
    first, box = wait_for_types(listener, arrays, Marker.CUBE).markers
    assert first.action == Marker.DELETEALL
    assert (box.header.frame_id, box.ns) == ('crate/body', 'crate')
    assert (box.scale.x, box.scale.y, box.scale.z, box.pose.position.z) == (1, 2, 3, 1)
    assert len(arrays) == 1
    late = start_listener()
    wait_for_types(late, arrays_of(late), Marker.CUBE)
    assert reload(listener).success
    assert wait_for_types(listener, arrays, Marker.SPHERE).markers[0].action == Marker.DELETEALL


def test_a_file_is_set_while_markers_are_made(listener, tmp_path):
    slow = SlowFile(tmp_path / 'slow.sdf', '<sdf version="1.10"><model name="m">'
                    '<link name="l"/></model></sdf>')
    including, small = tmp_path / 'including.sdf', tmp_path / 'small.sdf'
    including.write_text('<sdf version="1.10"><world name="w"><include><uri>slow.sdf</uri>'
                         '</include></world></sdf>')
    small.write_text(crate(BALL))
    set_parameters(listener, sdf_file=str(including))
    slow.hold()
    arrays = arrays_of(listener)
    with slow.opened():
        set_parameters(listener, sdf_file=str(small))
        wait_for_types(listener, arrays, Marker.SPHERE)
