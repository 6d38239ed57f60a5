# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What a load leaves in memory, paths that fail, texts in any encoding, and measured poses."""

import gc

from lxml import etree
import numpy as np
import pytest
from sdf_texts import joint, model_file, posed, world_file

from sdf_pose_bridge import load_text
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.tf.frame_ids import FrameNaming
from sdf_pose_bridge.tf.loaded_scene import DescriptionFormat, fingerprint_of_scene, LoadRequest
from sdf_pose_bridge.tf.loading import (
    loaded_scene_from_request,
    unicode_text,
    write_frame_change,
)
from sdf_pose_bridge.tf.tree import TfOptions

GOOD = '<model name="m"><link name="l"><pose>1 0 0 0 0 0</pose></link><frame name="f"/></model>'
BAD = GOOD.replace('<pose>', '<pose relative_to="x">')

ARM = model_file(
    '<link name="base"/>' + posed('link', 'tool', '1 0 0 0 0 0')
    + posed('frame', 'mark', '2 0 0 0 0 0') + posed('frame', 'on_mark', '0 0 1 0 0 0', 'mark')
    + joint('<pose relative_to="base"/><parent>base</parent><child>tool</child>'
            '<axis><xyz>0 0 1</xyz></axis>', 'turn', 'revolute'))

TEXT = '<robot name="größe"/>'


@pytest.mark.parametrize('text', [GOOD, BAD], ids=['good', 'bad'])
def test_nothing_is_left_that_only_a_search_for_garbage_would_free(tmp_path, text):
    path = tmp_path / 'cell.sdf'
    path.write_text(world_file(text), encoding='utf-8')

    def load():
        try:
            loaded_scene_from_request(LoadRequest(str(path), ''))
        except SdfError:
            assert text is BAD

    load()
    gc.collect()
    gc.disable()
    try:
        load()
        assert gc.collect() == 0
    finally:
        gc.enable()


def test_a_path_that_is_too_long_is_said_to_be():
    with pytest.raises(SdfError, match='File name too long'):
        loaded_scene_from_request(LoadRequest(f'/{"x" * 1000}', ''))


def test_a_text_has_the_name_of_its_parameter_and_no_file():
    text = world_file(GOOD)
    loaded = loaded_scene_from_request(LoadRequest('', text))
    assert (str(loaded.path), loaded.text, loaded.files) == ('robot_description', text, ())
    with pytest.raises(SdfError, match='robot_description:2: FILE_READ'):
        loaded_scene_from_request(LoadRequest('', '<sdf>\n<'))


@pytest.mark.parametrize('text', [TEXT, TEXT.encode(), TEXT.encode('utf-8-sig')])
def test_a_text_stays_as_it_is(text):
    assert unicode_text(text) == TEXT


@pytest.mark.parametrize('encoding', ['latin-1', 'utf-16'])
def test_another_encoding_is_converted(encoding):
    text = unicode_text(f'<?xml version="1.0" encoding="{encoding}"?>{TEXT}'.encode(encoding))
    assert etree.fromstring(text).get('name') == 'größe'


# URDF

def described(text, **options):
    """Return the description of a text as URDF, and all warnings."""
    loaded = loaded_scene_from_request(LoadRequest(
        '', text, tf_options=TfOptions(**options), description_format=DescriptionFormat.URDF))
    return loaded.description, [str(warning) for warning in loaded.warnings]


def test_a_world_of_several_models_has_no_urdf():
    description, (warning,) = described(world_file(GOOD + GOOD.replace('"m"', '"n"')))
    assert description == ''
    assert warning == (
        'robot_description: URDF_NOT_MADE: there is no robot_description, because no URDF can be '
        'made: URDF describes one robot, and the file has the models "m", "n"; choose one by '
        '--model or the parameter model')


def test_urdf_is_that_of_the_model_that_is_published():
    description, warnings = described(
        world_file(GOOD + GOOD.replace('"m"', '"n"')), model='n', frame_separator='-',
        frame_prefix='r/', root_frame='map', optical_frames=False)
    assert warnings == []
    assert '<robot name="n">' in description
    assert [name for name in ('n-l', 'n-f', 'n') if f'<link name="{name}"/>' in description] == [
        'n-l', 'n-f', 'n']


def test_all_options_of_frames_reach_the_urdf():
    class Options(TfOptions):
        """Options with a rule that only this test knows."""

        @property
        def naming(self):
            return FrameNaming(separator='+')

    loaded = loaded_scene_from_request(LoadRequest(
        '', model_file('<model name="n"><link name="l"/></model>'), tf_options=Options(),
        description_format=DescriptionFormat.URDF))
    assert set(loaded.tree.frame_ids) == {'m', 'n', 'n+l'}
    assert all(f'<link name="{each}"' in loaded.description for each in loaded.tree.frame_ids)


def test_urdf_has_shapes():
    box = '<visual name="v"><geometry><box/></geometry></visual>'
    description, _ = described(model_file(f'<link name="l">{box}</link>'))
    assert '<box size="1 1 1"/>' in description


def test_urdf_stays_as_it_is():
    text = '<robot name="r"><!-- mine --><link name="l"/></robot>'
    assert described(text)[0] == text


def test_warning_about_a_loop_is_given_once():
    ends = '<parent>a</parent><child>b</child>'
    _, warnings = described(model_file(
        '<link name="a"/><link name="b"/>' + joint(ends, 'j') + joint(ends, 'k')))
    assert len(warnings) == 1


@pytest.fixture(name='change')
def make_change(tmp_path):
    """Finds a change of the arm; ``change(frame, pose, reference, *positions)``."""
    path = tmp_path / 'arm.sdf'
    path.write_text(ARM, encoding='utf-8')
    request = LoadRequest(str(path), '', tf_options=TfOptions(use_joint_states=True))
    loaded = loaded_scene_from_request(request)
    fingerprint = fingerprint_of_scene(loaded.scene)

    def change(frame, pose, reference='', position=0.0, published=fingerprint):
        positions = loaded.joint_positions
        positions.update(positions.selection(['turn']), np.array([position]))
        write_frame_change(
            request, published, frame, pose, reference, positions, dry_run=False)
        return path.read_text(encoding='utf-8')

    return change


def test_a_pose_is_taken_where_its_reference_has_moved_to(change):
    text = change('mark', Pose(0.5), 'tool', np.pi / 2)
    np.testing.assert_allclose(
        load_text(text).pose('m::mark')[:3], (0.0, 1.5, 0.0), atol=1e-9)


def test_a_file_that_is_not_what_is_published(change):
    with pytest.raises(SdfError, match='the file has changed since it was read'):
        change('mark', Pose(), published=b'other')
