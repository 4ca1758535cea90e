"""The Markdown of the repository as pages: their links and anchors, and a copy of them for MkDocs.

The manual is in docs/; the READMEs to which it leads belong to the site, too. In the copy docs/ is the root, and
everything else is below repository/, with links between both changed accordingly.
"""

import pathlib
import posixpath
import re
import shutil
import urllib.parse

MANUAL = "docs"
ELSEWHERE = "repository"
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


def slug(heading, _separator="-"):
    """A heading's anchor. MkDocs calls it, too: the site has the anchors of the repository's pages on GitHub."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def anchors(text):
    """The anchors of a page's headings, by the rules of GitHub."""
    found, counts = set(), {}
    for heading in HEADING.findall(_blank(FENCE, text)):
        heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        name = slug(heading)
        found.add(name if name not in counts else f"{name}-{counts[name]}")
        counts[name] = counts.get(name, 0) + 1
    return found


def _part_lists(text):
    """Blank lines before lists, and four spaces before paragraphs of an item: Python's Markdown needs both, GitHub does not."""
    lines, in_code, in_text = [], False, False
    for line in text.split("\n"):
        item = re.match(r"(?:[-*]|\d+\.) ", line)
        after_blank = not lines or not lines[-1].strip()
        if in_text and item and not in_code:
            lines.append("")
        if after_blank and re.match(r" {2,3}[^ ]", line) and not in_code:
            line = "    " + line.strip()
        in_code ^= line.startswith("```")
        in_text = bool(line.strip()) and not item and (in_text or after_blank)
        lines.append(line)
    return "\n".join(lines)


def target_of(page, path):
    """The path in the repository of a link's path."""
    return posixpath.normpath(posixpath.join(posixpath.dirname(page), path)) if path else page


def line_of(text, place):
    return text.count("\n", 0, place) + 1


class Pages:
    """All pages that are reached from docs/ and from the README of the repository."""

    def __init__(self, root):
        self.root = pathlib.Path(root)
        self.texts, self.files, self.dead, self.external, self.checked = {}, set(), [], {}, 0
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
            if (self.root / target).is_file() and not target.endswith(".md"):
                self.files.add(target)
            yield target, anchor

    def _check_anchors(self):
        known = {name: anchors(text) for name, text in self.texts.items()}
        for name, text in self.texts.items():
            for link in links(text):
                path, _, anchor = link[0].partition("#")
                target = target_of(name, path)
                if anchor and target in known and anchor not in known[target]:
                    self.dead.append(f"{name}:{line_of(text, link.start())}: {target} has no heading '#{anchor}'")

    def _moved(self, name, link):
        """A link of a page as it is in the copy."""
        if is_external(link) or link.startswith("#"):
            return link
        path, hash_sign, anchor = link.partition("#")
        target = target_of(name, path)
        if (self.root / target / "README.md").is_file():
            target += "/README.md"
        return posixpath.relpath(place_in_copy(target), posixpath.dirname(place_in_copy(name)) or ".") + hash_sign + anchor

    def copy(self, folder):
        """Writes the pages, and all files to which they have links, into a new folder."""
        folder = pathlib.Path(folder)
        shutil.rmtree(folder, ignore_errors=True)
        for name, text in self.texts.items():
            for link in reversed(list(links(text))):
                text = text[:link.start()] + self._moved(name, link[0]) + text[link.end():]
            target = folder / place_in_copy(name)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(_part_lists(text), encoding="utf-8")
        for name in self.files:
            target = folder / place_in_copy(name)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(self.root / name, target)


def place_in_copy(name):
    """The path in the copy of a file of the repository."""
    return name[len(MANUAL) + 1:] if name.startswith(MANUAL + "/") else posixpath.join(ELSEWHERE, name)
