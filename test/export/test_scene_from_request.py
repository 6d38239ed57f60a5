# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What a load leaves in memory, paths that fail, and texts in any encoding."""

import gc

from lxml import etree
import pytest
from sdf_texts import joint, model_file, world_file

from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.export.published_scene import DescriptionFormat, LoadRequest
from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request, unicode_text
from sdf_pose_bridge.tf.frame_ids import FrameNaming
from sdf_pose_bridge.tf.tree import TfOptions

GOOD = '<model name="m"><link name="l"><pose>1 0 0 0 0 0</pose></link><frame name="f"/></model>'
BAD = GOOD.replace('<pose>', '<pose relative_to="x">')

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


def test_a_name_for_the_model_of_a_world_has_no_effect():
    loaded = loaded_scene_from_request(LoadRequest('', world_file(GOOD), model_name='robot7'))
    assert loaded.scene.has('m::l')
    (warning,) = loaded.warnings
    assert 'model_name has no effect' in warning.message


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
