# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The server of the page, which only users with the address of the page can use, and its events.

Private names of viser are used only here.
"""

from __future__ import annotations

from collections.abc import Callable
import contextlib
import hashlib
import html
from http import HTTPStatus
import logging
import os
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
from sdf_pose_bridge.cli.viewer.frame_texts import html_of_data

_ADDRESS = '127.0.0.1'
_HOSTS = r'(127\.0\.0\.1|localhost)(:[0-9]+)?'
_PAGE_OF_VISER = Path(viser.__file__).parent / 'client/build/index.html'
_TITLE = '<title>Viser</title>'


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


def key_of_file(path: str) -> str:
    """
    Return a key by which the tabs of a file find its page when it is served again.

    :return: the same one whenever this user serves this file; another one each time if nothing can
        be kept in the folder of the user's state.
    """
    key, state = secrets.token_bytes(32), os.environ.get('XDG_STATE_HOME') or '~/.local/state'
    with contextlib.suppress(OSError, RuntimeError):
        kept = Path(state, 'sdf_pose_bridge/key_of_pages').expanduser()
        status = kept.stat() if kept.exists() else None
        # Nobody else could read or write it, and it was written to its end.
        if status and (status.st_uid, status.st_mode & 0o77, status.st_size) == (
                os.getuid(), 0, len(key)):
            key = kept.read_bytes()
        else:
            kept.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            kept.unlink(missing_ok=True)
            kept.touch(0o600, exist_ok=False)
            kept.write_bytes(key)
    return hashlib.sha256(key + os.fsencode(os.path.realpath(path))).hexdigest()


def server_for_its_owner(
    port: int, title: str, path: str, was_asked: threading.Event,
) -> tuple[viser.ViserServer, str]:
    """
    Start a server for this user only, not for other machines, users or pages of other servers.

    :param port: its port, or the next one that is free; 0 for any.
    :param path: the file that its page shows.
    :param was_asked: set when a browser asks for the page.
    :return: the server, and the address of its page: with a secret in its path, without which
        requests are rejected.
    :raises UntestedViserError: if this cannot be done with the installed viser.
    """
    rich.get_console().quiet = True
    # Otherwise connections that a browser opens in advance and closes are logged as errors.
    logging.getLogger('websockets').setLevel(logging.CRITICAL)
    # A tab may be closed while its page is drawn.
    warnings.filterwarnings('ignore', '.* on a closed connection', UserWarning)
    salt, key = secrets.token_urlsafe(16), key_of_file(path) if port else secrets.token_hex(32)
    page = page_with_script(
        _PAGE_OF_VISER.read_text(encoding='utf-8'), title,
        html_of_data('path', str(Path(path).resolve())) + html_of_data('key', key)).encode()
    serve, guarded = websockets_server.serve, []

    def answer(connection: ServerConnection, request: Request) -> Response | None:
        reason = reason_to_refuse(request, secret_of_page(key, salt, connection.local_address[1]))
        if reason:
            refusal = connection.respond(HTTPStatus.FORBIDDEN, f'{reason}\n')
            refusal.headers['Salt'] = salt
            return refusal
        was_asked.set()
        if request.headers.get('Upgrade') == 'websocket':
            return None
        return Response(HTTPStatus.OK, 'OK', Headers({
            'Content-Type': 'text/html; charset=utf-8', 'Content-Length': str(len(page))}), page)

    def guarded_serve(*arguments: Any, **options: Any) -> Any:
        guarded.append(answer)
        return serve(*arguments, **{**options, 'process_request': answer})

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
    port = server.get_port()
    return server, f'http://{_ADDRESS}:{port}/{secret_of_page(key, salt, port)}/'


def secret_of_page(key: str, salt: str, port: int) -> str:
    """
    Return the secret in the address of a page, which tabs with the key of its file find too.

    The salt, which anybody may know, is another one for each start. A program of another user that
    listens where a page was served before learns no secret of the page, as that has another port.
    """
    return hashlib.sha256(f'{key}{salt}{_ADDRESS}:{port}'.encode()).hexdigest()[:32]


def reason_to_refuse(request: Request, secret: str) -> str:
    """
    Judge a request for the page, or for a connection.

    :param secret: the beginning of its path.
    :return: the reason why it is rejected; empty if it is not.
    """
    given = ''.join(request.path.partition('?')[0].split('/')[1:2])
    if not secrets.compare_digest(given.encode(errors='replace'), secret.encode()):
        return 'no page has this address; open the one that "sdf_pose view" printed at its start'
    hosts, origins = (request.headers.get_all(name) for name in ('Host', 'Origin'))
    if not re.fullmatch(_HOSTS, ' '.join(hosts)) or origins not in ([], [f'http://{hosts[0]}']):
        return 'only the page of this server may connect'
    return ''
