# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A browser without a window, told what to do by the DevTools protocol of Chromium."""

import contextlib
import itertools
import json
import subprocess
import time
from urllib.parse import urlsplit
from urllib.request import Request, urlopen

from deadline import DEADLINE_S, wait_until
import needs
from processes import started
import pytest

OPTIONS = (
    # WebGL alone by SwiftShader: the page around it would take most of the start there.
    '--headless', '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader-webgl',
    '--enable-unsafe-swiftshader', '--disable-quic', '--no-first-run',
    '--disable-background-networking', '--disable-component-update', '--disable-sync',
    # A process that has compiled the script of a page opens it again in less time.
    '--process-per-site', '--webgl-antialiasing-mode=none', '--remote-debugging-port=0')
FEW_FRAMES = """(draw => {
  window.requestAnimationFrame = action => setTimeout(() => draw(action), 100);
  window.cancelAnimationFrame = clearTimeout;
})(window.requestAnimationFrame);
WebGL2RenderingContext.prototype.drawElements = () => {};"""
"""Ten frames a second at most, and only what has instances, as bodies and axes: without a graphics
card, more frames would take a whole core, and the background is most of a frame."""

REPLACED = 'Inspected target navigated or closed'
"""The error of what is asked while another page takes the place of this one."""


class Tab:
    """A tab of a browser; ``requests`` has the address of everything that it asked for."""

    def __init__(self, socket, browser):
        self._browser = browser
        self._socket, self._numbers = socket, itertools.count(1)
        self.requests, self.errors = [], []
        for domain in ('Page', 'Network', 'Runtime'):
            self.call(f'{domain}.enable')
        # It is drawn, also where another tab is in front of it.
        self.call('Emulation.setFocusEmulationEnabled', enabled=True)
        self.call('Page.addScriptToEvaluateOnNewDocument', source=FEW_FRAMES)

    def call(self, method, **parameters):
        number = next(self._numbers)
        self._socket.send(json.dumps({'id': number, 'method': method, 'params': parameters}))
        while True:
            message = json.loads(self._socket.recv(timeout=DEADLINE_S))
            if message.get('id') == number:
                if message.get('error', {}).get('message') == REPLACED:
                    return self.call(method, **parameters)
                assert 'error' not in message, message
                return message['result']
            if message.get('method') == 'Network.requestWillBeSent':
                self.requests.append(message['params']['request']['url'])
            elif message.get('method') == 'Network.webSocketCreated':
                self.requests.append(message['params']['url'])
            elif message.get('method') == 'Runtime.exceptionThrown':
                self.errors.append(message['params']['exceptionDetails'])

    @contextlib.contextmanager
    def other(self):
        """Open another tab."""
        tab = self.call('Target.createTarget', url='about:blank')['targetId']
        with _tab(self._browser, tab) as other:
            yield other
            other.call('Target.closeTarget', targetId=tab)

    def open(self, address):
        self.call('Page.navigate', url=address)

    def run(self, script):
        """Return the value of an expression of JavaScript."""
        result = self.call(
            'Runtime.evaluate', expression=script, returnByValue=True, awaitPromise=True)
        assert 'exceptionDetails' not in result, result
        return result['result'].get('value')

    def wait_for(self, script):
        """Wait until an expression is true."""
        wait_until(
            lambda: self.run(f'Boolean({script})'), lambda: time.sleep(0.05), lambda: script)

    def size(self, width, height):
        """Set the size of the window in pixels of CSS; few pixels are drawn of each."""
        self.call('Emulation.setDeviceMetricsOverride', width=width, height=height,
                  deviceScaleFactor=0.25, mobile=False)

    def keys(self, *keys):
        """Press and release keys: characters, or keys by their names."""
        codes = {'Tab': 9, 'Enter': 13, 'Escape': 27, 'ArrowUp': 38, 'ArrowRight': 39,
                 'ArrowDown': 40}
        for key in keys:
            text = {'Enter': '\r'}.get(key, key[:len(key) == 1])
            self.call('Input.dispatchKeyEvent', type='keyDown', key=key, text=text,
                      windowsVirtualKeyCode=codes.get(key, 0))
            self.call('Input.dispatchKeyEvent', type='keyUp', key=key,
                      windowsVirtualKeyCode=codes.get(key, 0))

    def mouse(self, *steps):
        """Press at the first of some points, move over them, and release at the last one."""
        for kind, (x, y) in (
                ('mouseMoved', steps[0]), ('mousePressed', steps[0]),
                *(('mouseMoved', step) for step in steps[1:]), ('mouseReleased', steps[-1])):
            self.call('Input.dispatchMouseEvent', type=kind, x=x, y=y, button='left',
                      buttons=int(kind != 'mouseReleased'), clickCount=1)


@contextlib.contextmanager
def _tab(browser, name):
    client = pytest.importorskip('websockets.sync.client', reason='needs websockets')
    with client.connect(f'ws://{browser}/devtools/page/{name}', max_size=None,
                        open_timeout=DEADLINE_S, ping_interval=None) as socket:
        yield Tab(socket, browser)


@contextlib.contextmanager
def browser(folder):
    """
    Start a browser that keeps its files in a folder; the context is its tab.

    Skip where there is no browser, or nothing that it could show.
    """
    process = started(
        [needs.browser(), *OPTIONS, f'--user-data-dir={folder}', 'about:blank'],
        stderr=subprocess.PIPE, text=True)
    try:
        line = next(line for line in process.stderr if 'DevTools listening on' in line)
        address = urlsplit(line.split()[-1]).netloc
        with urlopen(Request(f'http://{address}/json/new', method='PUT')) as answer:
            name = json.load(answer)['id']
        with _tab(address, name) as tab:
            yield tab
    finally:
        process.terminate()
        process.communicate()
