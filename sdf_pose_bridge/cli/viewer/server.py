# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The server of the page, which only users with the address of the page can use, and its events.

Private names of viser are used only here.
"""

from __future__ import annotations

from collections.abc import Callable
import html
from http import HTTPStatus
import logging
from pathlib import Path
from queue import SimpleQueue
import re
import secrets
import threading
from typing import Any
import warnings

import rich
import viser
from websockets.asyncio import server as websockets_server
from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from sdf_pose_bridge.cli.viewer import LIBRARIES, UntestedViserError

_ADDRESS = '127.0.0.1'
_HOSTS = r'(127\.0\.0\.1|localhost)(:[0-9]+)?'
_PAGE_OF_VISER = Path(viser.__file__).parent / 'client/build/index.html'
_TITLE = '<title>Viser</title>'
_LONGEST_HANDSHAKE_S = 3.0
"""A browser opens connections in advance, and the server does not end before these."""


class Events:
    """The requests of a tab, which viser receives in its threads, for one that ``wake`` wakes."""

    def __init__(self, wake: threading.Event) -> None:
        self._wake, self._asked = wake, SimpleQueue[Callable[[], object]]()

    def put(self, action: Callable[[], object]) -> None:
        """Add a function to call."""
        self._asked.put(action)
        self._wake.set()

    def when(
        self, happens: Callable[..., object], action: Callable[[], object] = lambda: None,
    ) -> None:
        """Add a function at each event, such as ``button.on_click``."""
        async def put(_: object) -> None:
            self.put(action)
        happens(put)

    def asked(self) -> list[Callable[[], object]]:
        """Return the functions to call."""
        return [self._asked.get_nowait() for _ in range(self._asked.qsize())]


def page_with_script(page: str, title: str, data: str = '') -> str:
    """
    Add features that viser does not have to a page of it: page.css and page.js.

    :param data: elements with data for the script.
    """
    style, script = (
        Path(__file__).with_name(name).read_text(encoding='utf-8')
        for name in ('page.css', 'page.js'))
    return page.replace(
        _TITLE, f'<title>{html.escape(title)}</title>{data}<style>{style}</style>'
        f'<script>{script}</script>', 1)


def server_for_its_owner(
    port: int, title: str, data: str = '',
) -> tuple[viser.ViserServer, str]:
    """
    Start a server for this user only, not for other machines, users or pages of other servers.

    :param port: its port, or the next one that is free; 0 for any.
    :param data: elements of its page with data for the script.
    :return: the server, and the address of its page: with a secret in its path, without which
        requests are rejected.
    :raises UntestedViserError: if this cannot be done with the installed viser.
    """
    rich.get_console().quiet = True
    # Otherwise connections that a browser opens in advance and closes are logged as errors.
    logging.getLogger('websockets').setLevel(logging.CRITICAL)
    # A tab may be closed while its page is drawn.
    warnings.filterwarnings('ignore', '.* on a closed connection', UserWarning)
    secret = secrets.token_urlsafe(16)
    page = page_with_script(_PAGE_OF_VISER.read_text(encoding='utf-8'), title, data).encode()
    serve, guarded = websockets_server.serve, []

    def answer(connection: ServerConnection, request: Request) -> Response | None:
        reason = reason_to_refuse(request, secret)
        if reason:
            return connection.respond(HTTPStatus.FORBIDDEN, f'{reason}\n')
        if request.headers.get('Upgrade') == 'websocket':
            return None
        return Response(HTTPStatus.OK, 'OK', Headers({
            'Content-Type': 'text/html; charset=utf-8', 'Content-Length': str(len(page))}), page)

    def guarded_serve(*arguments: Any, **options: Any) -> Any:
        guarded.append(answer)
        return serve(*arguments, **{
            **options, 'process_request': answer, 'open_timeout': _LONGEST_HANDSHAKE_S})

    # viser has no hook for this, so it replaces the function by which viser starts its server.
    # After viser has accepted a connection, it would be too late for earlier requests.
    websockets_server.serve = guarded_serve  # type: ignore[assignment,misc]
    try:
        server = viser.ViserServer(_ADDRESS, port, verbose=False)
    finally:
        websockets_server.serve = serve  # type: ignore[misc]
    if not guarded:
        msg = (f'viser {viser.__version__} does not work as the releases that this is tested with '
               f'({LIBRARIES[0]})')
        raise UntestedViserError(msg)
    server.gui.set_panel_label(title)
    server.gui.configure_theme(show_logo=False, show_share_button=False)
    # The environment map of viser makes every color pale.
    server.scene.configure_environment_map(None)
    server.scene.configure_default_lights(enabled=False)
    return server, f'http://{_ADDRESS}:{server.get_port()}/{secret}/'


def reason_to_refuse(request: Request, secret: str) -> str:
    """
    Judge a request for the page, or for a connection.

    :param secret: the beginning of its path.
    :return: the reason why it is rejected; empty if it is not.
    """
    given = ''.join(request.path.partition('?')[0].split('/')[1:2])
    if not secrets.compare_digest(given.encode(errors='replace'), secret.encode()):
        return 'this page is shown only at the address that sdf_pose view has printed'
    hosts, origins = (request.headers.get_all(name) for name in ('Host', 'Origin'))
    if not re.fullmatch(_HOSTS, ' '.join(hosts)) or origins not in ([], [f'http://{hosts[0]}']):
        return 'only the page of this server may connect'
    return ''
