#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""links.py FOLDER: checks every link of the pages in a folder: its file is there, its anchor too,
and nothing is fetched from elsewhere to show a page. Prints what is wrong, and counts."""

import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

FETCHED = {"script": "src", "img": "src", "iframe": "src", "source": "src", "video": "src",
           "link": "href"}


class Page(HTMLParser):
    def __init__(self, path):
        super().__init__(convert_charrefs=True)
        self.anchors, self.links, self.fetched = set(), [], []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.anchors.update(attrs[key] for key in ("id", "name") if attrs.get(key))
        target = attrs.get(FETCHED.get(tag))
        if target and attrs.get("rel") not in {"canonical", "prev", "next"}:
            self.fetched.append((self.getpos()[0], target))
        elif attrs.get("href"):
            self.links.append((self.getpos()[0], attrs["href"]))


def main(folder):
    folder = Path(folder).resolve()
    pages = {path: Page(path) for path in sorted(folder.rglob("*.html"))}
    wrong = [f"{path.relative_to(folder)}: {target} is fetched from elsewhere"
             for path in sorted(folder.rglob("*.css"))
             for target in re.findall(r"url\([\"']?((?:https?:)?//[^)]*)", path.read_text())]
    local, anchors, outward = 0, 0, set()
    for path, page in pages.items():
        for line, target in page.links + page.fetched:
            here = f"{path.relative_to(folder)}:{line}: {target}"
            url = urlsplit(target)
            if url.scheme in {"http", "https", "mailto"} or url.netloc:
                outward.add(target)
                if (line, target) in page.fetched:
                    wrong.append(f"{here} is fetched from elsewhere")
                continue
            if url.scheme in {"javascript", "data"}:
                continue
            if url.path.startswith("/"):
                wrong.append(f"{here} only works at the top of a server")
                continue
            local += 1
            to = (path.parent / unquote(url.path)).resolve() if url.path else path
            to = to / "index.html" if to.is_dir() else to
            if not to.is_file():
                wrong.append(f"{here} does not exist")
            elif url.fragment and to in pages:
                anchors += 1
                # MkDocs has its own ways to the top of a page.
                if unquote(url.fragment) not in pages[to].anchors | {"__skip", "__top"}:
                    wrong.append(f"{here} has no such place")
    print("\n".join(wrong), end="\n" if wrong else "")
    print(f"{len(pages)} pages, {local} local links of which {anchors} to a place on a page, "
          f"{len(outward)} addresses elsewhere, not visited; {len(wrong)} wrong")
    return 1 if wrong or not local else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
