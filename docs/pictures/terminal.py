# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Draw what a program printed to a terminal of 80 columns, from standard input, as SVG."""

import io
import re
import sys

from rich._export_format import CONSOLE_SVG_FORMAT
from rich.console import Console
from rich.text import Text

console = Console(record=True, width=80, file=io.StringIO())
console.print(Text.from_ansi(sys.stdin.read()))
# The format loads a font from the Internet.
without_font = re.sub(r'@font-face {{.*?}}|<!--.*?-->', '', CONSOLE_SVG_FORMAT, flags=re.DOTALL)
sys.stdout.write(console.export_svg(
    title=sys.argv[1], code_format=without_font, unique_id='terminal'))
