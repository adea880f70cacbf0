"""The indices name everything that is there, and nothing that is not: plugins, configs, pages, links, paths in the text."""
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import follow

ROOT = Path(__file__).resolve().parents[2]
README = ROOT / "README.md"
README_LINES = 100
CODE = re.compile(r"^ *```.*?^ *```|`[^`\n]*`", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\(([^)\s]+)\)|^\[[^\]]+\]: +(\S+)", re.MULTILINE)
USED = re.compile(r"\]\[([^\]]+)\]|\| \[([^\]]+)\] \|")  # [text][label], and a cell that is a label alone
# Paths of the tree in backticks, such as `plugins/soccer` or `tools/accept fast`: word for word, no patterns.
NAMED = re.compile(r"`((?:core|plugins|lua|scenes|tests|tools|docs|cmake)/[\w./-]*[\w])(?=[` ])")


def links(page):
    """The relative links of a page outside of code, as paths."""
    found = ((a or b).partition("#")[0] for a, b in LINK.findall(CODE.sub("", page.read_text())))
    return [(page.parent / target).resolve() for target in found if target and not re.match(r"\w+:", target)]


def undefined_labels(text):
    """Labels of links that the page uses and does not define."""
    defined = set(re.findall(r"^\[([^\]]+)\]: ", text, re.MULTILINE))
    return sorted({a or b for a, b in USED.findall(CODE.sub("", text))} - defined) if defined else []


def has_commands(page):
    return any(kind == "sh" and not name.startswith(follow.SKIP) for _, kind, name, _ in follow.blocks(page))


def followed():
    """The pages that ctest follows, from CMakeLists.txt."""
    names = re.search(r"set\(followed_pages ([^)]*)\)", (Path(__file__).parent / "CMakeLists.txt").read_text())[1].split()
    return [ROOT / f"{name}.md" for name in names]


def pages():
    """All pages of the tree that are about Spark as it is now. The changelog also names what is gone."""
    out = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"], cwd=ROOT, capture_output=True, text=True)
    names = out.stdout.split() if out.returncode == 0 and out.stdout else \
        [p.relative_to(ROOT).as_posix() for p in ROOT.rglob("*.md") if not {"node_modules", "build"} & set(p.parts)]
    return [ROOT / name for name in names if name != "CHANGELOG.md" and (ROOT / name).exists()]


class Indices(unittest.TestCase):
    def named(self, index, things):
        """Each thing is the target of a link, or a name in backticks, of the page `index`."""
        text, targets = index.read_text(), links(index)
        for thing in things:
            with self.subTest(index=index.relative_to(ROOT).as_posix(), missing=thing.relative_to(ROOT).as_posix()):
                self.assertTrue(thing in targets or f"`{thing.name}`" in text,
                                f"add a row about {thing.relative_to(ROOT)} to {index.relative_to(ROOT)}")

    def test_every_plugin_is_in_the_index_of_plugins(self):
        plugins = [file.parent for file in ROOT.glob("plugins/*/CMakeLists.txt") if "spark_plugin(" in file.read_text()]
        self.assertGreater(len(plugins), 20)
        self.named(ROOT / "plugins/README.md", [p / "README.md" for p in plugins])

    def test_every_config_is_in_the_page_about_configs(self):
        self.named(ROOT / "lua/README.md", sorted(ROOT.glob("lua/*.lua")))

    def test_the_reference_of_house_lua_has_its_functions_and_options(self):
        rows = dict(re.findall(r"^\| `(\w+)[({].*?` \| (.*?) \|", (ROOT / "lua/README.md").read_text(), re.MULTILINE))
        code = re.split(r"^function (\w+)", (ROOT / "lua/house.lua").read_text(), flags=re.MULTILINE)
        for name, body in zip(code[1::2], code[2::2]):
            with self.subTest(function=name):
                options = re.findall(r'\boption\{ name = "(\w+)"', body)
                self.assertIn(name, rows, "add a row to lua/README.md")
                self.assertLessEqual(set(options), set(re.findall(r"`(\w+)`", rows[name])), "name its options in lua/README.md")

    def test_every_page_of_docs_is_in_the_index_of_docs(self):
        self.named(ROOT / "docs/README.md", sorted(set(ROOT.glob("docs/*.md")) - {ROOT / "docs/README.md"}))

    def test_every_readme_is_linked_from_some_page(self):
        linked = {target for page in pages() for target in links(page)}
        linked |= {target / "README.md" for target in linked}
        for page in pages():
            with self.subTest(page=page.relative_to(ROOT).as_posix()):
                self.assertTrue(page in linked or page == README, "no page links it")

    def test_links_lead_somewhere(self):
        for page in pages():
            with self.subTest(page=page.relative_to(ROOT).as_posix()):
                self.assertEqual(undefined_labels(page.read_text()), [])
            for target in links(page):
                with self.subTest(page=page.relative_to(ROOT).as_posix()):
                    self.assertTrue(target.exists(), f"{target} does not exist")

    def test_paths_in_the_text_exist(self):
        for page in pages():
            for name in NAMED.findall(page.read_text()):
                with self.subTest(page=page.relative_to(ROOT).as_posix()):
                    self.assertTrue(exists(page, name), f"{name} does not exist")

    def test_configs_in_commands_exist(self):
        own = {name for page in pages() for _, kind, name, _ in follow.blocks(page) if name.endswith(".lua")}  # made by the page
        for page in pages():
            for name in re.findall(r"--config ([\w./-]+\.lua)\b", page.read_text()):
                with self.subTest(page=page.relative_to(ROOT).as_posix()):
                    self.assertTrue((ROOT / "lua" / name).exists() or name in own or name == "NAME.lua", f"there is no config {name}")


def exists(page, name):
    """Whether a path is in the tree, or in the folder of the page; a header may also be named from its include folder."""
    places = [ROOT, page.parent, *ROOT.glob("core/*/include")]
    return any((place / name).exists() or list(place.glob(f"{name}.*")) for place in places)


class Links(unittest.TestCase):
    def test_code_has_no_links_and_labels_are_links(self):
        with tempfile.TemporaryDirectory() as folder:
            page = Path(folder) / "page.md"
            page.write_text("[a](b.md#x) `[c](no.md)` [d](https://e.org) [e](#here) [f][g]\n```\n[h](no.md)\n```\n[g]: i.md\n[j][k]\n")
            self.assertEqual([p.name for p in links(page)], ["b.md", "i.md"])
            self.assertEqual(undefined_labels(page.read_text()), ["k"])


class FrontDoor(unittest.TestCase):
    def test_the_readme_is_short(self):
        self.assertLessEqual(len(README.read_text().splitlines()), README_LINES)

    def test_every_page_with_commands_that_it_links_is_followed(self):
        wanted = [page for page in [README, *links(README)] if page.suffix == ".md" and has_commands(page)]
        self.assertGreater(len(wanted), 4)
        for page in wanted:
            with self.subTest(page=page.relative_to(ROOT).as_posix()):
                self.assertIn(page, followed(), "add it to followed_pages in tests/pages/CMakeLists.txt")

    def test_its_claims_name_commands_that_exist(self):
        points = dict(re.findall(r"`tools/accept ([\w-]+) (\w+)`", README.read_text()))
        self.assertGreaterEqual(len(points), 3)
        milestones = (ROOT / "tools/accept").read_text()
        for milestone, point in points.items():
            module = ROOT / f"tools/acceptance/{milestone.replace('-', '_')}.py"
            text = module.read_text() if module.exists() else milestones
            with self.subTest(milestone=milestone):
                self.assertIn(f'"{milestone}":', milestones)
                self.assertIn(f'"{point}": (', text)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
