# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Which requests the server of the page answers; page/ asks it."""

import html
from http import HTTPStatus
import re
from threading import Event
from urllib.request import urlopen

from deadline import DEADLINE_S
import pytest

pytest.importorskip('viser', reason='needs viser')
from websockets.asyncio import server as websockets_server
from websockets.datastructures import Headers
from websockets.http11 import Request

from sdf_pose_bridge.cli.viewer.frame_texts import html_of_data
from sdf_pose_bridge.cli.viewer.server import (
    key_of_file,
    page_with_script,
    reason_to_refuse,
    secret_of_page,
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


def test_each_start_has_its_own_secret():
    serve, was_asked = websockets_server.serve, [Event(), Event()]
    servers = [server_for_its_owner(0, 'a', 'a.sdf', each) for each in was_asked]
    assert websockets_server.serve is serve
    secrets = {address.split('/')[3] for _, address in servers}
    with urlopen(servers[0][1], timeout=DEADLINE_S) as page:
        assert page.status == HTTPStatus.OK
    for server, _ in servers:
        server.stop()
    assert [each.is_set() for each in was_asked] == [True, False]
    assert len(secrets) == 2
    assert all(len(secret) > 20 for secret in secrets)


def test_secret_depends_on_the_port_where_another_program_may_listen_later():
    secrets = {secret_of_page('key', 'salt', port) for port in (8080, 8081)}
    assert len(secrets | {secret_of_page('other', 'salt', 8080)}) == 3


@pytest.fixture
def kept(tmp_path, monkeypatch):
    """The file of the key, which is not there yet."""
    monkeypatch.setenv('XDG_STATE_HOME', str(tmp_path / 'state'))
    return tmp_path / 'state/sdf_pose_bridge/key_of_pages'


def test_file_has_one_key_that_its_user_alone_can_read(kept, tmp_path):
    (tmp_path / 'link.sdf').symlink_to('a.sdf')
    keys = [key_of_file(str(tmp_path / name)) for name in ('a.sdf', 'link.sdf', 'b.sdf')]
    assert keys[0] == keys[1] != keys[2]
    assert [path.stat().st_mode & 0o777 for path in (kept.parent, kept)] == [0o700, 0o600]


@pytest.mark.parametrize('damage', [
    lambda kept: kept.chmod(0o640), lambda kept: kept.write_bytes(b'')])
def test_key_that_others_could_know_is_replaced(kept, damage):
    before = key_of_file('a.sdf')
    damage(kept)
    after = key_of_file('a.sdf')
    assert before != after == key_of_file('a.sdf')
    assert (kept.stat().st_mode & 0o777, kept.stat().st_size) == (0o600, 32)


def test_key_is_another_one_each_time_where_none_can_be_kept(kept, tmp_path):
    (tmp_path / 'state').touch()
    assert key_of_file('a.sdf') != key_of_file('a.sdf')
