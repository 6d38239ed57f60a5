# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Which requests the server of the page answers; page/ asks it."""

import html
import re
from socket import create_connection

from deadline import DEADLINE_S
import pytest

pytest.importorskip('viser', reason='needs viser')
from websockets.asyncio import server as websockets_server
from websockets.datastructures import Headers
from websockets.http11 import Request

from sdf_pose_bridge.cli.viewer import server as server_module
from sdf_pose_bridge.cli.viewer.frame_texts import html_of_data
from sdf_pose_bridge.cli.viewer.server import (
    page_with_script,
    reason_to_refuse,
    server_for_its_owner,
)

HERE = 'http://127.0.0.1:8080'
HOSTILE = '"><script>'


def test_title_and_data_are_escaped_and_the_rest_stays():
    page = page_with_script(
        '<head><title>Viser</title></head><body>', HOSTILE, html_of_data('names', HOSTILE))
    (value,) = re.match(
        '<head><title>&quot;&gt;&lt;script&gt;</title><meta data-names="([^"<>]*)"><style>',
        page).groups()
    assert html.unescape(value) == HOSTILE
    assert page.endswith('</script></head><body>')


@pytest.mark.parametrize('path', ['/secret', '/secret/', '/secret/?a=/b', '/secret/index.html'])
@pytest.mark.parametrize(('origin', 'host'), [
    (None, '127.0.0.1:8080'), (HERE, '127.0.0.1:8080'),
    # As by "ssh -L 9000:127.0.0.1:8080".
    ('http://localhost:9000', 'localhost:9000')])
def test_the_page_is_answered(path, origin, host):
    assert reason_to_refuse(request(path, origin, host), 'secret') == ''


@pytest.mark.parametrize(('path', 'origin', 'host', 'reason'), [
    *((path, HERE, '127.0.0.1:8080', 'printed') for path in (
        '', '/', '//', '/secre', '/secrets/', '/x/secret', '/?secret', '//secret/', '/%73ecret/',
        '/é/', '//[/secret/', '/\udcff/')),
    *(('/secret/', origin, host, 'only the page') for origin, host in (
        ('http://127.0.0.1:9999', '127.0.0.1:8080'), ('http://localhost:8080', '127.0.0.1:8080'),
        ('https://127.0.0.1:8080', '127.0.0.1:8080'), ('null', '127.0.0.1:8080'),
        ('', '127.0.0.1'), (None, 'example.org'), (None, None), (HERE, '[127'),
        # A name that its owner lets stand for this machine.
        ('http://example.org:8080', 'example.org:8080'))),
])
def test_without_the_secret_and_to_other_pages_nothing_is_answered(path, origin, host, reason):
    assert reason in reason_to_refuse(request(path, origin, host), 'secret')


def request(path, origin, host):
    headers = Headers()
    for name, value in (('Origin', origin), ('Host', host)):
        if value is not None:
            headers[name] = value
    return Request(path, headers)


def test_each_server_has_its_own_secret():
    serve = websockets_server.serve
    servers = [server_for_its_owner(0, 'a.sdf') for _ in range(2)]
    assert websockets_server.serve is serve
    secrets = {address.split('/')[3] for _, address in servers}
    for server, _ in servers:
        server.stop()
    assert len(secrets) == 2
    assert all(len(secret) > 20 for secret in secrets)


def test_connection_that_is_opened_in_advance_does_not_keep_it_from_ending(monkeypatch):
    monkeypatch.setattr(server_module, '_LONGEST_HANDSHAKE_S', 0.1)
    server, _ = server_for_its_owner(0, 'a.sdf')
    with create_connection(('127.0.0.1', server.get_port()), timeout=DEADLINE_S) as connection:
        assert connection.recv(1) == b''
    server.stop()
