# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose view``: pages, and libraries that are not installed."""

from importlib.metadata import version
import os
import re
import signal
import socket
import sys
from threading import Event
import time
from types import SimpleNamespace
from urllib.parse import urlsplit
import webbrowser

from command_line import COMMAND, completed, ENVIRONMENT
from folders import ROOT
import mesh_texts
import needs
import pytest

from sdf_pose_bridge import load
from sdf_pose_bridge.file_watcher import FileWatcher

MESH = """<sdf version="1.9"><model name="m"><link name="l"><visual name="v"><geometry>
  <mesh><uri>none.stl</uri></mesh></geometry></visual></link></model></sdf>"""


@pytest.fixture(autouse=True)
def viser():
    """Skips where viser is not installed."""
    return pytest.importorskip('viser', reason='needs viser')


def test_missing_library_is_an_error_of_one_line(refused, monkeypatch):
    for module in [name for name in sys.modules if name.startswith('sdf_pose_bridge.cli.viewer.')]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, 'viser', None)
    assert refused('view', 'good.sdf', '-o', 'page.html').startswith(
        'sdf_pose view: this needs viser, trimesh and pycollada, and viser is missing: ')


@pytest.mark.parametrize(('name', 'old', 'oldest'), [
    ('viser', '0.2.23', '1.1.1'), ('viser', '1.0.0rc1', '1.1.1'), ('trimesh', '4.5.1', '5.0')])
def test_library_that_is_too_old_is_an_error_of_one_line(refused, monkeypatch, name, old, oldest):
    versions = {name: old}
    monkeypatch.setattr(
        'importlib.metadata.version', lambda each: versions.get(each, version(each)))
    assert refused('view', 'good.sdf', '-o', 'page.html').startswith(
        f'sdf_pose view: this needs {name} {oldest} or newer and found {old}: ')


@pytest.mark.parametrize(('is_of_apt', 'way'), [
    (False, "found 4.5.1: pip install 'viser>="), (True, 'found 4.5.1: python3 -m venv ')])
def test_a_python_of_apt_needs_an_environment(run_main, monkeypatch, tmp_path, is_of_apt, way):
    monkeypatch.setattr(
        'importlib.metadata.version',
        lambda each: '4.5.1' if each == 'trimesh' else version(each))
    monkeypatch.setattr('sys.prefix', sys.base_prefix)
    monkeypatch.setattr('sysconfig.get_path', lambda *_: str(tmp_path))
    if is_of_apt:
        (tmp_path / 'EXTERNALLY-MANAGED').touch()
    assert way in run_main('view', 'good.sdf', '-o', 'page.html').stderr


@pytest.mark.parametrize(('name', 'output', 'reason'), [
    ('viser.ViserServer', 'page.html', 'does not work as the releases'),
    ('shutil.which', 'page.png',
     'cannot write page.png: a picture needs Chrome or Chromium;')])
def test_viser_or_a_browser_that_cannot_be_started_is_an_error_of_one_line(
        refused, monkeypatch, name, output, reason):
    monkeypatch.setattr(name, lambda *_, **__: None)
    assert reason in refused('view', 'good.sdf', '-o', output)


# It reaches what a browser of snap does.
CONFINED = """#!/bin/sh
for word; do case $word in --screenshot=*) picture=${word#*=};; esac; done
case $picture in
  "$HOME"/.* | "$HOME"/*/.*) exit 1;;
  "$HOME"/*) cp "$(dirname "$picture")/page.html" "$picture";;
esac
"""


@pytest.mark.parametrize(('folder', 'is_reached'), [
    ('home/pictures', True), ('home/.hidden', False), ('elsewhere', False)])
def test_picture_by_a_browser_that_does_not_reach_all_folders(
        run_main, monkeypatch, tmp_path, folder, is_reached):
    needs.executables_in(tmp_path)
    program, output = tmp_path / 'chromium', tmp_path / folder / 'page.png'
    output.parent.mkdir(parents=True)
    program.write_text(CONFINED)
    program.chmod(0o755)
    monkeypatch.setenv('PATH', f'{tmp_path}:{os.defpath}')
    monkeypatch.setenv('HOME', str(tmp_path / 'home'))
    done = run_main('view', 'good.sdf', '-o', str(output))
    assert list(output.parent.iterdir()) == ([output] if is_reached else [])
    reason = f'cannot write {output}: {program} wrote no picture into that folder; a browser of '
    assert (done.returncode, reason in done.stderr) == (int(not is_reached), not is_reached)


# It ends the command, and writes files until it is ended itself.
ENDING_ITS_PARENT = """#!/bin/sh
trap 'exit 0' TERM
for word; do case $word in --user-data-dir=*) folder=${word#*=};; esac; done
kill -%d "$PPID"
while :; do touch "$folder/left" || exit 1; done
"""


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_while_a_picture_is_drawn_ends_the_browser_and_leaves_nothing(
        files, tmp_path_factory, number):
    pytest.importorskip('viser', reason='needs viser')
    folders = [tmp_path_factory.mktemp(name) for name in ('bin', 'temporary')]
    needs.executables_in(folders[0])
    browser, before = folders[0] / 'chromium', {*files.iterdir()}
    browser.write_text(ENDING_ITS_PARENT % number)
    browser.chmod(0o755)
    done = completed([*COMMAND, 'view', 'good.sdf', '-o', 'page.png'], cwd=files, env={
        **ENVIRONMENT, 'PATH': f'{folders[0]}:{os.defpath}', 'TMPDIR': str(folders[1])})
    assert (done.returncode, done.stdout, done.stderr) == (-number, '', '')
    assert {*files.iterdir()} == before
    assert not [*folders[1].iterdir()]


def test_page_has_a_title_and_needs_no_network(run_main, files):
    done = run_main('view', 'good.sdf', '-o', 'page.html')
    assert (done.returncode, done.stdout, done.stderr) == (0, '', '')
    page = (files / 'page.html').read_text()
    assert '<title>good.sdf</title>' in page
    assert '<script src=' not in page
    assert 'stylesheet' not in page.partition('<body>')[0].partition('<script')[0]


def test_what_is_not_drawn_is_said(run_on):
    done = run_on(MESH, 'view', '-o', 'page.html')
    assert done.returncode == 0
    assert done.stderr.startswith(
        'sdf_pose view: 1 shape cannot be drawn: the mesh "none.stl": it is not in ".";')


def test_a_texture_that_was_read_is_not_replaced(run_on, files):
    (files / 'mesh.obj').write_text(mesh_texts.TEXTURED_OBJ)
    (files / 'colors.mtl').write_text('newmtl m\nmap_Kd texture.png\n')
    texture = files / 'texture.png'
    pytest.importorskip('PIL.Image').new('RGB', (4, 4)).save(texture)
    before = texture.read_bytes()
    (files / 'page.html').symlink_to('texture.png')
    done = run_on(MESH.replace('none.stl', 'mesh.obj'), 'view', '-o', 'page.html')
    assert done.stderr.startswith('page.html: FILE_WRITE: this file was read')
    assert texture.read_bytes() == before


def test_page_opens_in_the_browser(run_main, monkeypatch):
    opened = []

    def stop(*_):
        raise SystemExit(0)

    monkeypatch.setattr(webbrowser, 'open', lambda uri: bool(opened.append(uri)))
    monkeypatch.setattr('sdf_pose_bridge.cli.view._follow', stop)
    done = run_main('view', 'good.sdf', '--port', '0')
    assert re.fullmatch(
        r'open http://127\.0\.0\.1:[0-9]+/[\w-]+/ in a browser; Ctrl-C ends this program\n',
        done.stdout)
    assert (done.returncode, opened, done.stderr) == (0, [done.stdout.split()[1]], '')
    port = urlsplit(opened[0]).port
    with socket.create_server(('127.0.0.1', port)):
        done = run_main('view', 'good.sdf', '--port', str(port))
    assert done.stderr == f'sdf_pose view: port {port} is in use\n'
    assert urlsplit(opened[1]).port != port


@pytest.mark.parametrize('was_asked', [False, True])
def test_no_browser_is_opened_where_a_tab_asks_for_the_page(monkeypatch, was_asked):
    from sdf_pose_bridge.cli import view
    opened, asked = [], Event()
    if was_asked:
        asked.set()
    monkeypatch.setattr(webbrowser, 'open', opened.append)
    view._open(SimpleNamespace(address='http://127.0.0.1:1/a/', was_asked=asked), 1)
    assert bool(opened) is not was_asked


def test_broken_file_that_is_included_anew_is_read_again_when_it_is_mended(tmp_path):
    from sdf_pose_bridge.cli import view
    main, part = tmp_path / 'main.sdf', tmp_path / 'part.sdf'
    main.write_text(MESH)
    scene, watcher, shown = load(main), FileWatcher(), []
    watcher.watch(scene.files, time.time_ns())
    pages = SimpleNamespace(act=lambda _: None, show=shown.append,
                            show_errors=lambda lines: shown.append([*lines]))
    part.write_text('<sdf')
    include = '<include><uri>part.sdf</uri></include>'
    for file, text in (
            (main, f'<sdf version="1.11"><world name="w">{include}</world></sdf>'), (part, MESH)):
        file.write_text(text)
        view._follow(pages, watcher, lambda: load(main))
    (error,), mended = shown
    assert 'part.sdf' in error
    assert mended.has('m::l')


@pytest.mark.parametrize('port', ['80000', '-1', 'http'])
def test_port_that_is_none(files, run_main, port):
    done = run_main('view', 'good.sdf', f'--port={port}')
    assert done.returncode == 2
    assert done.stderr.endswith(f'argument --port: "{port}" is not a port, 0 to 65535\n')


def test_libraries_are_imported_only_by_the_command(files):
    program = ('import sys; from sdf_pose_bridge.cli.main import main\n'
               'main(["tree", "good.sdf"])\n'
               'sys.exit(str({"viser", "trimesh", "webbrowser"} & set(sys.modules)))')
    done = completed([sys.executable, '-c', program], cwd=files, env={'PYTHONPATH': str(ROOT)})
    assert done.stderr == 'set()\n'
