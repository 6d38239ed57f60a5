# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The page in a real browser where the program has ended and is started again."""

import contextlib
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
import socket
from threading import Thread

from shown_page import (
    control,
    HOSTILE,
    press,
    ROWS,
    select,
    strip_button,
    TEXT,
    type_over,
    view_of,
)

from sdf_pose_bridge import load

TOP = "[...document.querySelectorAll('button')].find(button => button.innerText === 'top')"
IS_FROM_ABOVE = """(axis => axis && Math.abs(axis.split(' ').at(-1)) < 3)(
  document.querySelector('.axis-cross path:last-child').getAttribute('d'))"""
FRAME = '<frame name="one more"><pose>0 0 0 0 0 0</pose></frame></world>'


@contextlib.contextmanager
def other_program(port, salt=''):
    """Answer any request at a port, as servers of many web applications do; or first a salt."""
    class Handler(BaseHTTPRequestHandler):
        def do_GET(self):
            is_refused = salt and self.path == '/'
            self.send_response(HTTPStatus.FORBIDDEN if is_refused else HTTPStatus.OK)
            self.send_header('Salt', salt)
            self.end_headers()

        def log_message(self, *_):
            pass

    with ThreadingHTTPServer(('127.0.0.1', int(port)), Handler) as server:
        thread = Thread(target=server.serve_forever)
        thread.start()
        try:
            yield
        finally:
            server.shutdown()
            thread.join()


def test_tab_shows_its_file_and_nothing_else_that_is_served_again(tab, tmp_path):
    with socket.create_server(('127.0.0.1', 0)) as server:
        port = str(server.getsockname()[1])
    (tmp_path / 'other').mkdir()
    (tmp_path / 'other/cell.sdf').write_text(TEXT)
    file = tmp_path / 'cell.sdf'
    file.write_text(TEXT)
    with view_of(tmp_path, '--edit', '--port', port) as address:
        tab.open(address)
        for number in ('0.5', '0.7'):
            select(tab, HOSTILE)
            type_over(tab, control('x [m]'), number)
            tab.wait_for(strip_button('write to file'))
            if number == '0.5':
                press(tab, 'write to file')
        tab.run(f'{TOP}.click()')
        tab.wait_for(IS_FROM_ABOVE)
        salt = tab.run("fetch('/').then(answer => answer.headers.get('Salt'))")
    tab.run("""{ const fetched = window.fetch; window.fetch = async (...given) => {
      const answer = await fetched(...given);
      answers.push(answer.status);
      return answer;
    }; }""")
    for other, status in (
            (other_program(port), 200),
            # The program that ends may answer once more.
            (other_program(port, salt), 403),
            (view_of(tmp_path / 'other', '--port', port), 403)):
        with other:
            tab.run('window.answers = []')
            tab.wait_for('answers.length >= 3')
            # The first one may be of what was served before.
            assert {*tab.run('answers.slice(1)')} == {status}
            assert tab.run('location.href').startswith(address)
            assert 'view has ended' in tab.run("document.querySelector('.strip').innerText")
    file.write_text(TEXT.replace('</world>', FRAME))
    with view_of(tmp_path, '--edit', '--port', port) as again:
        assert again != address
        tab.wait_for(f"location.href.startsWith('{again}') && {ROWS}.length === 6")
        # Nothing of what was typed or written before is left, but what is shown stays.
        tab.wait_for(f"document.querySelector('.rows .selected')?.textContent === '{HOSTILE}'")
        tab.wait_for(IS_FROM_ABOVE)
        assert tab.run("document.querySelectorAll('.strip button').length") == 0
        select(tab, 'one more')
        type_over(tab, control('y [m]'), '2')
        press(tab, 'write to file')
        scene = load(file)
        assert (scene.pose('one more').y, scene.pose(HOSTILE).x) == (2.0, 1.0)
