# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose view``: pages, and libraries that are not installed."""

from pathlib import Path
import subprocess
import sys
import webbrowser

import pytest

ROOT = Path(__file__).resolve().parents[2]
MESH = """<sdf version="1.9"><model name="m"><link name="l"><visual name="v"><geometry>
  <mesh><uri>none.stl</uri></mesh></geometry></visual></link></model></sdf>"""


@pytest.fixture
def plotly():
    """Skips where plotly is not installed."""
    return pytest.importorskip('plotly', reason='needs plotly')


def test_missing_library_is_an_error_of_one_line(run_main, monkeypatch):
    monkeypatch.setitem(sys.modules, 'plotly.io', None)
    done = run_main('view', 'good.sdf', '-o', 'page.html')
    assert (done.returncode, done.stdout) == (1, '')
    assert done.stderr.startswith('sdf_pose view: this needs the library plotly: pip install ')
    assert len(done.stderr.splitlines()) == 1


def test_missing_library_of_pictures_is_an_error_of_one_line(run_main, monkeypatch, plotly):
    monkeypatch.setitem(sys.modules, 'kaleido', None)
    done = run_main('view', 'good.sdf', '-o', 'page.png')
    assert done.returncode == 1
    assert done.stderr.startswith('sdf_pose view: a picture needs the library kaleido ')
    assert len(done.stderr.splitlines()) == 1


def test_unknown_format_is_an_error(run_main):
    done = run_main('view', 'good.sdf', '-o', 'page.svg')
    assert done.returncode == 2
    assert '"page.svg" must end with one of .html, .png' in done.stderr


def test_invalid_file_is_reported(run_main, plotly):
    done = run_main('view', 'bad.sdf', '-o', 'page.html')
    assert done.returncode == 1
    assert done.stderr.startswith('bad.sdf:3: ELEMENT_INVALID: ')


def test_unknown_model_is_an_error(run_main, plotly):
    done = run_main('view', 'good.sdf', '--model', 'n', '-o', 'page.html')
    assert done.returncode == 1
    assert 'there is no model "n"' in done.stderr


def test_folder_that_does_not_exist_is_an_error(run_main, plotly):
    done = run_main('view', 'good.sdf', '-o', 'nowhere/page.html')
    assert done.returncode == 1
    assert done.stderr.startswith('sdf_pose view: cannot write nowhere/page.html: ')


def test_page_has_the_frames_and_needs_no_network(run_main, files, plotly):
    done = run_main('view', 'good.sdf', '-o', 'page.html')
    assert (done.returncode, done.stdout, done.stderr) == (0, '', '')
    page = (files / 'page.html').read_text()
    assert 'm/l' in page.replace('\\u002f', '/')
    assert '<script src=' not in page
    assert '<link' not in page


def test_what_is_not_drawn_is_said(run_main, files, plotly):
    (files / 'mesh.sdf').write_text(MESH)
    done = run_main('view', 'mesh.sdf', '-o', 'page.html')
    assert done.returncode == 0
    assert done.stderr == (
        'sdf_pose view: 1 shape is not drawn: the mesh "none.stl" is not found\n')


@pytest.mark.parametrize('has_browser', [True, False])
def test_page_opens_in_the_browser(run_main, files, monkeypatch, plotly, has_browser):
    opened = []
    monkeypatch.setenv('TMPDIR', str(files))
    monkeypatch.setattr('tempfile.tempdir', None)
    monkeypatch.setattr(webbrowser, 'open', lambda uri: bool(opened.append(uri)) or has_browser)
    done = run_main('view', 'good.sdf')
    (page,) = files.glob('sdf_pose_view_*.html')
    assert (done.returncode, done.stdout, opened) == (0, f'{page}\n', [page.as_uri()])
    assert bool(done.stderr) is not has_browser


def test_libraries_are_imported_only_by_the_command(files):
    program = ('import sys; from sdf_pose_bridge.cli.main import main\n'
               'main(["tree", "good.sdf"])\n'
               'sys.exit(str({"plotly", "trimesh", "webbrowser"} & set(sys.modules)))')
    done = subprocess.run(
        [sys.executable, '-c', program], cwd=files, env={'PYTHONPATH': str(ROOT)},
        capture_output=True, text=True, check=False)
    assert done.stderr == 'set()\n'
