"""The pages of the manual, docs/, and the READMEs to which they lead: their links and anchors."""

import pathlib
import posixpath
import re
import urllib.parse

MANUAL = "docs"
LINK = re.compile(r"(?<=\]\()[^()\s]+(?=\))")
FENCE = re.compile(r"^```.*?^```[^\S\n]*$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"(?<!`)`[^`]+`(?!`)")
HEADING = re.compile(r"^#{1,6} +(.+?) *#*$", re.MULTILINE)


def _blank(pattern, text):
    return pattern.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)


def is_external(link):
    return bool(urllib.parse.urlsplit(link).scheme)


def links(text):
    """The places of all links of a page, without those in code."""
    return LINK.finditer(_blank(CODE, _blank(FENCE, text)))


def anchors(text):
    """The anchors of a page's headings, by the rules of GitHub."""
    found, counts = set(), {}
    for heading in HEADING.findall(_blank(FENCE, text)):
        heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        name = re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")
        found.add(name if name not in counts else f"{name}-{counts[name]}")
        counts[name] = counts.get(name, 0) + 1
    return found


def target_of(page, path):
    """The path in the repository of a link's path."""
    return posixpath.normpath(posixpath.join(posixpath.dirname(page), path)) if path else page


def line_of(text, place):
    return text.count("\n", 0, place) + 1


class Pages:
    """All pages that are reached from docs/ and from the README of the repository."""

    def __init__(self, root):
        self.root = pathlib.Path(root)
        self.texts, self.dead, self.external, self.checked = {}, [], {}, 0
        waiting = [f"{MANUAL}/{page.name}" for page in self.root.glob(f"{MANUAL}/*.md")] + ["README.md"]
        while waiting:
            name = waiting.pop()
            if name not in self.texts:
                self.texts[name] = (self.root / name).read_text(encoding="utf-8")
                waiting += [target for target, _ in self._targets(name) if target.endswith(".md")]
        self._check_anchors()

    def _targets(self, name):
        """Targets of a page, as paths in the repository with their anchors; records those that are not there."""
        for link in links(self.texts[name]):
            self.checked += 1
            place = f"{name}:{line_of(self.texts[name], link.start())}"
            if is_external(link[0]):
                self.external.setdefault(link[0], place)
                continue
            path, _, anchor = link[0].partition("#")
            target = target_of(name, path)
            if target.startswith("../") or not (self.root / target).exists():
                self.dead.append(f"{place}: '{link[0]}' is not there")
                continue
            yield target, anchor

    def _check_anchors(self):
        known = {name: anchors(text) for name, text in self.texts.items()}
        for name, text in self.texts.items():
            for link in links(text):
                path, _, anchor = link[0].partition("#")
                target = target_of(name, path)
                if anchor and target in known and anchor not in known[target]:
                    self.dead.append(f"{name}:{line_of(text, link.start())}: {target} has no heading '#{anchor}'")
