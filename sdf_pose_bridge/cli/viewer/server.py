# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A server of viser for this machine alone, and pages and pictures of what it shows."""

from __future__ import annotations

import html
import logging
from pathlib import Path
import shutil
import subprocess
import tempfile
import time
from typing import Any
from urllib.parse import urlsplit

import imageio.v3 as imageio
import numpy as np
import rich
import viser
from viser.infra import WebsockClientConnection

from sdf_pose_bridge.cli.viewer.drawing import NAMES
from sdf_pose_bridge.names import printable

ADDRESS = '127.0.0.1'
_OWN_HOSTS = (ADDRESS, 'localhost')
_BROWSERS = ('chromium', 'chromium-browser', 'google-chrome', 'chrome')
# WebGL in software where there is no graphics card; no requests but those of the page.
_BROWSER_OPTIONS = (
    '--headless', '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader', '--no-first-run', '--disable-background-networking',
    '--disable-component-update', '--disable-sync', '--disable-quic',
    # What the window itself shows is not looked at, and a fine one takes the most time.
    '--window-size=1600,1000', '--force-device-scale-factor=0.25')
_PICTURE_HEIGHT, _PICTURE_WIDTH, _SMALL = 1000, 1600, 10
_MOST_SECONDS = 300.0
_MOST_SECONDS_FOR_NAMES = 30.0
_PERIOD_S = 0.3


class PictureError(RuntimeError):
    """A picture cannot be made; the message says why."""


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


def page_from_server(server: viser.ViserServer, title: str) -> str:
    """
    Return what a server shows as one page that needs no network.

    :param title: the title of the page.
    :return: its HTML.
    """
    page: str = server.get_scene_serializer().as_html()
    return page.replace('<title>Viser</title>', f'<title>{html.escape(printable(title))}</title>')


def write_picture(server: viser.ViserServer, path: Path) -> None:
    """
    Write what a server shows as a picture, by a browser without a window.

    :param path: where to write it.
    :raises PictureError: if there is no browser, or it does not show the page.
    :raises OSError: if the picture cannot be written.
    """
    browser = next(filter(None, map(shutil.which, _BROWSERS)), None)
    if browser is None:
        msg = 'a picture needs Chrome or Chromium; a file that ends with .html does not'
        raise PictureError(msg)
    # The last processes of the browser may still write while the first has ended.
    with tempfile.TemporaryDirectory(
            prefix='sdf_pose_view_', ignore_cleanup_errors=True) as folder:
        process = subprocess.Popen(
            [browser, *_BROWSER_OPTIONS, f'--user-data-dir={folder}',
             f'http://{ADDRESS}:{server.get_port()}'],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            pixels = _pixels(server, process)
        except (RuntimeError, TimeoutError) as error:
            msg = f'the browser did not draw the page: {error}'
            raise PictureError(msg) from error
        finally:
            process.terminate()
            process.wait()
    rgb, alpha = pixels[:, :, :3].astype(float), pixels[:, :, 3:] / 255.0
    imageio.imwrite(path, (rgb * alpha + 255.0 * (1.0 - alpha)).astype(np.uint8))


def _pixels(server: viser.ViserServer, browser: subprocess.Popen[bytes]) -> Any:
    """Wait for the browser and let it draw; shape (height, width, 4), red green blue alpha."""
    end = time.monotonic() + _MOST_SECONDS
    eye, names = server.initial_camera.position, server.scene.get_handle_by_name(NAMES)
    assert names is not None
    names.visible = False
    # A browser that has connected looks from elsewhere until it has read the scene.
    while not any(np.allclose(client.camera.position, eye, rtol=1e-3, atol=1e-3)
                  for client in server.get_clients().values()):
        if browser.poll() is not None or time.monotonic() > end:
            msg = 'it did not show it'
            raise RuntimeError(msg)
        time.sleep(0.05)
    (client, *_) = server.get_clients().values()

    def pixels(part: int) -> Any:
        return client.get_render(
            _PICTURE_HEIGHT // part, _PICTURE_WIDTH // part, transport_format='png',
            timeout=_MOST_SECONDS)

    # No message says when all is drawn. When nothing else changes any more, the names are shown,
    # which come later; when they are there, the picture has changed once more.
    old, new = np.empty(0), pixels(_SMALL)
    while not np.array_equal(old, new):
        time.sleep(_PERIOD_S)
        old, new = new, pixels(_SMALL)
    names.visible = True
    end = time.monotonic() + _MOST_SECONDS_FOR_NAMES
    while np.array_equal(old, new) and time.monotonic() < end:
        time.sleep(_PERIOD_S)
        new = pixels(_SMALL)
    return pixels(1)
