#!/usr/bin/env python3
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Follows every local link of the HTML pages below a folder: check_links.py FOLDER

Places inside a page are looked up for pages that people wrote; Doxygen's own lists name a few
sections that it then leaves out.
"""
import pathlib
import sys
from html.parser import HTMLParser
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.links, self.anchors = [], set()
        self.feed(path.read_text(errors="replace"))

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.anchors.update(attributes[key] for key in ("id", "name") if attributes.get(key))
        self.links += [attributes[key] for key in ("href", "src") if attributes.get(key)]


def main(folder):
    root = pathlib.Path(folder).resolve()
    pages = {path: Page(path) for path in root.rglob("*.html")}
    n_links = 0
    dead = set()
    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            n_links += 1
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            target = target / "index.html" if target.is_dir() else target
            fragment = unquote(parts.fragment)
            written = path.name.startswith(("md_", "index"))
            if not target.exists() or (written and fragment and fragment not in pages[target].anchors):
                dead.add(f"{path.relative_to(root)}: {link}")
    print("\n".join(sorted(dead)[:50]))
    print(f"{n_links} links in {len(pages)} pages, {len(dead)} dead")
    return bool(dead) or not pages


sys.exit(main(*sys.argv[1:]))
