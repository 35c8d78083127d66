#!/usr/bin/python3
"""Checks a built site: each link leads to a file and an anchor of the site, and nothing is loaded from elsewhere."""

import html.parser
import os
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.anchors, self.links, self.loads = {"", "top"}, [], []
        with open(path, encoding="utf-8") as file:
            self.feed(file.read())

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.anchors.update(filter(None, (attrs.get("id"), attrs.get("name") if tag == "a" else None)))
        if tag == "a" and attrs.get("href"):
            self.links.append(attrs["href"])
        elif tag == "link" and attrs.get("rel") != "canonical" and attrs.get("href"):
            self.loads.append(attrs["href"])
        elif attrs.get("src"):
            self.loads.append(attrs["src"])


def main():
    site = os.path.abspath(sys.argv[1])
    pages = {}
    for folder, _, names in os.walk(site):
        for name in names:
            if name.endswith(".html"):
                path = os.path.join(folder, name)
                pages[path] = Page(path)
    if not pages:
        sys.exit(f"check_links.py: no pages in {site}")
    num = 0
    for path, page in sorted(pages.items()):
        # Doxygen checks its own; the page for what is not found is shown at any address.
        if path.startswith(os.path.join(site, "api", "")) or path == os.path.join(site, "404.html"):
            continue
        for link in page.links + page.loads:
            url = urllib.parse.urlsplit(link)
            why = ""
            if url.scheme in ("http", "https", "mailto") or url.netloc:
                why = "is loaded from elsewhere" if link in page.loads else ""
            elif url.path.startswith("/"):
                why = "holds only where the site is the root of a server"
            elif not url.scheme:
                target = path
                if url.path:
                    target = os.path.normpath(os.path.join(os.path.dirname(path), urllib.parse.unquote(url.path)))
                    if os.path.isdir(target):
                        target = os.path.join(target, "index.html")
                if not os.path.exists(target):
                    why = "leads nowhere"
                elif target in pages and urllib.parse.unquote(url.fragment) not in pages[target].anchors:
                    why = "leads to no such heading"
            if why:
                num += 1
                print(f"{os.path.relpath(path, site)}: {link} {why}", file=sys.stderr)
    print(f"{len(pages)} pages, {num} broken links")
    return int(num > 0)


if __name__ == "__main__":
    sys.exit(main())
