# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A page that tests use one after the other."""

import json
from types import SimpleNamespace

from browser import browser
import needs
import pytest
from shown_page import (
    control,
    HOSTILE,
    ROWS,
    SCENES,
    select,
    TEXT,
    view_of,
)

NAMES = "document.querySelector('[data-names]').dataset.names"


@pytest.fixture(scope='session')
def shown(tmp_path_factory):
    """A file that ``view`` shows, and a browser that shows its page."""
    folder = tmp_path_factory.mktemp('page')
    file = folder / 'cell.sdf'
    file.write_text(TEXT)
    needs.browser()
    # The server ends soon where the browser has ended before.
    with view_of(folder, '--edit') as address, browser(folder / 'browser') as page:
        page.size(1366, 768)
        page.call('Page.addScriptToEvaluateOnNewDocument', source=SCENES)
        page.open(address)
        page.wait_for(f'{ROWS}.length > 0')
        yield SimpleNamespace(file=file, page=page, address=address, names=page.run(NAMES))


@pytest.fixture
def page(shown):
    """The page of the file as it was at first."""
    if shown.file.read_text() != TEXT:
        shown.file.write_text(TEXT)
    shown.page.wait_for(f"{NAMES} === {json.dumps(shown.names)} && {control('rail')}"
                        f" && {ROWS}.length === 5 && !document.querySelector('.errors')")
    # A frame that the last test has moved is back only when the file has been read again.
    select(shown.page, HOSTILE)
    shown.page.wait_for("document.body.innerText.includes('xyz 1.0000 0.0000 0.0000 m')")
    return shown.page


@pytest.fixture(params=[(1366, 768), (800, 600)])
def sized_page(page, request):
    page.size(*request.param)
    yield page
    page.size(1366, 768)


@pytest.fixture
def tab(shown):
    """Another tab of that browser."""
    with shown.page.other() as other:
        other.size(1366, 768)
        yield other
