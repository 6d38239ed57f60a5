# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A server of viser for this machine alone, and pages and pictures of what it shows."""

from __future__ import annotations

import contextlib
import html
import logging
from pathlib import Path
import shutil
import subprocess
import tempfile
from urllib.parse import urlsplit

import rich
import viser
from viser.infra import WebsockClientConnection

from sdf_pose_bridge.names import printable

ADDRESS = '127.0.0.1'
_OWN_HOSTS = (ADDRESS, 'localhost')
_BROWSERS = ('chromium', 'chromium-browser', 'google-chrome', 'chrome')
# WebGL in software where there is no graphics card; no requests but those of the page.
_BROWSER_OPTIONS = (
    '--headless', '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader', '--no-first-run', '--disable-background-networking',
    '--disable-component-update', '--disable-sync', '--disable-quic',
    # The picture is drawn when the page has had nothing to do for this long, in milliseconds.
    '--window-size=1600,1000', '--hide-scrollbars', '--virtual-time-budget=10000')
_ONLY_THE_SCENE = '<style>body :not(canvas, :has(canvas)) {visibility: hidden}</style>'
_MOST_SECONDS = 300.0


def server_for_this_machine(port: int) -> viser.ViserServer:
    """
    Start a server that other machines, and the pages of other servers, cannot reach.

    :param port: its port, or the next one that is free; 0 for any.
    :return: the server.
    """
    rich.get_console().quiet = True
    # Else each connection that a browser opens in advance, and closes, is an error with a trace.
    logging.getLogger('websockets').setLevel(logging.CRITICAL)
    server = viser.ViserServer(ADDRESS, port, verbose=False)
    sockets = server._websock_server  # noqa: SLF001  # viser itself accepts every page

    async def refuse_other_pages(connection: WebsockClientConnection) -> None:
        socket = sockets._live_connections[connection.client_id]  # noqa: SLF001
        origin = None if socket.request is None else socket.request.headers.get('Origin')
        if origin is not None and urlsplit(origin).hostname not in _OWN_HOSTS:
            await socket.close(1008, 'only pages of this server may connect')

    sockets.on_client_connect(refuse_other_pages)
    sockets.disconnect_all_clients()
    server.gui.configure_theme(show_logo=False, show_share_button=False)
    # The picture of surroundings that viser lights a scene with makes every color pale.
    server.scene.configure_environment_map(None)
    server.scene.configure_default_lights(cast_shadow=False)
    return server


def write_page(server: viser.ViserServer, title: str, path: Path) -> None:
    """
    Write what a server shows as one page that needs no network, or as a picture.

    :param title: the title of the page.
    :param path: where to write it; a picture if it ends with ``.png``.
    :raises OSError: if it cannot be written, or no browser draws the picture.
    """
    page: str = server.get_scene_serializer().as_html()
    page = page.replace('<title>Viser</title>', f'<title>{html.escape(printable(title))}</title>')
    path.write_bytes(_picture(page) if path.suffix.lower() == '.png' else page.encode())


def _picture(page: str) -> bytes:
    browser = next(filter(None, map(shutil.which, _BROWSERS)), None)
    if browser is None:
        msg = 'a picture needs Chrome or Chromium; a file that ends with .html does not'
        raise FileNotFoundError(msg)
    # The last processes of the browser may still write while the first has ended.
    with tempfile.TemporaryDirectory(
            prefix='sdf_pose_view_', ignore_cleanup_errors=True) as folder:
        source, picture = Path(folder, 'page.html'), Path(folder, 'picture.png')
        source.write_text(page + _ONLY_THE_SCENE, encoding='utf-8')
        command = [browser, *_BROWSER_OPTIONS, f'--user-data-dir={folder}',
                   f'--screenshot={picture}', source.as_uri()]
        with contextlib.suppress(subprocess.TimeoutExpired):
            subprocess.run(command, capture_output=True, check=False, timeout=_MOST_SECONDS)
        if picture.exists():
            return picture.read_bytes()
    msg = f'{browser} did not draw the page'
    raise ChildProcessError(msg)
