"""Every page and config is named in an index, and links between pages lead to files."""
import os
import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SKIPPED = {"build", "node_modules", ".git"}
CODE = re.compile(r"^ *```.*?^ *```|`[^`\n]*`", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\(([^)\s]+)\)|^\[[^\]]+\]: +(\S+)", re.MULTILINE)
USE = re.compile(r"\]\[([^\]]+)\]|\| \[([^\]]+)\] \|")  # [text][label], and a cell that is a label alone


def links(text):
    """The targets of a page's links, in its text and in the definitions of its labels."""
    return [a or b for a, b in LINK.findall(CODE.sub("", text))]


def dead_links(text, folder):
    """Links that lead to no file below or beside `folder`, and labels that are not defined."""
    files = [t.partition("#")[0] for t in links(text) if not re.match(r"[a-z]+:", t)]
    labels = set(re.findall(r"^\[([^\]]+)\]: ", text, re.MULTILINE))
    used = {a or b for a, b in USE.findall(CODE.sub("", text))} if labels else set()
    return [f for f in files if f and not (folder / f).exists()] + sorted(used - labels)


def pages():
    """All Markdown files of the sources."""
    for folder, folders, files in os.walk(ROOT):
        folders[:] = [f for f in folders if f not in SKIPPED]
        yield from (Path(folder) / f for f in files if f.endswith(".md"))


class Index(unittest.TestCase):
    def test_every_page_of_docs_is_in_its_index(self):
        named = links((ROOT / "docs/README.md").read_text())
        there = {f.name for f in (ROOT / "docs").glob("*.md")} - {"README.md"}
        self.assertEqual(sorted(there - set(named)), [], "docs/README.md has no link to these")

    def test_every_file_of_lua_is_in_its_index(self):
        index = (ROOT / "lua/README.md").read_text()
        missing = sorted(f.name for f in (ROOT / "lua").glob("*.lua") if f"`{f.name}`" not in index)
        self.assertEqual(missing, [], "lua/README.md does not name these")

    def test_links_between_pages_lead_to_files(self):
        found = list(pages())
        self.assertGreater(len(found), 40)
        for page in found:
            with self.subTest(page=str(page.relative_to(ROOT))):
                self.assertEqual(dead_links(page.read_text(), page.parent), [])

    def test_a_dead_link_is_found_and_code_is_no_link(self):
        text = "[a](index_test.py) [b](none.md#x) `[c](no.md)` [d](https://e.org) [e](#here)\n```\n[f](no.md)\n```\n"
        self.assertEqual(dead_links(text, Path(__file__).parent), ["none.md"])
        text = "| [a] | [b][c] |\n\n[a]: index_test.py\n[x]: none.py\n"
        self.assertEqual(dead_links(text, Path(__file__).parent), ["none.py", "c"])


if __name__ == "__main__":
    unittest.main()
