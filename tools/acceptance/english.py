"""Draws random sentences from comments and test names, and reads the table with their verdicts by people.

    python3 tools/acceptance/english.py SEED     prints 60 sentences, half of the product and half of tests, as rows of english.md

A verdict is `clear` (a colleague understands it at first sight), `slows` (at second sight) or `stops`.
"""
import random
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TABLE = Path(__file__).with_name("english.md")
FOLDERS = ("core", "plugins", "tools", "tests")
EACH = 30
SKIPPED = {"node_modules", "build", "__pycache__", "corpus"}
ROW = re.compile(r"^\| (product|tests) \| `(.+?)` \| (.+) \| (clear|slows|stops) \| (.*) \|$")


def is_test(path):
    return "tests" in path.relative_to(ROOT).parts


def paragraphs(path):
    """(line, text) of each comment and each test name; comments on consecutive lines are one."""
    mark = "#" if path.suffix == ".py" else "//"
    comment = re.compile(r"^\s*(?:///?<?|#)\s?(.*)$" if mark == "//" else r"^\s*#\s(.*)$")
    trailing = re.compile(r'\S\s+' + mark + r'[/<!]*\s(.+)$')
    begun, text = 0, []
    for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
        found = comment.match(line)
        if found and not line.lstrip().startswith("#") or found and mark == "#":
            begun, text = (begun if text else number), [*text, found[1].strip()]
            continue
        if text:
            yield begun, " ".join(text)
            text = []
        name = re.search(r'(?:TEST_CASE|SECTION)\(\s*"((?:[^"\\]|\\.)+)"', line) or re.search(r"\btest\(\"((?:[^\"\\]|\\.)+)\"", line)
        behind = trailing.search(line)
        if name:
            yield number, name[1]
        elif behind and '"' not in behind[1]:
            yield number, behind[1]
    if text:
        yield begun, " ".join(text)


def sentences():
    """(kind, file:line, sentence) of all sources, in order of files."""
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix not in (".h", ".cpp", ".py", ".ts", ".mjs") or SKIPPED & set(path.parts):
                continue
            kind = "tests" if is_test(path) else "product"
            for line, text in paragraphs(path):
                for sentence in re.split(r"(?<=[.!?])\s+(?=[A-Z`(])", re.sub(r"\\(file|brief)\b", "", text).strip()):
                    if len(re.findall(r"[A-Za-z]{2,}", sentence)) >= 5:
                        yield kind, f"{path.relative_to(ROOT)}:{line}", sentence


def drawn(seed):
    everything = list(sentences())
    dice = random.Random(seed)
    for kind in ("product", "tests"):
        yield from dice.sample([s for s in everything if s[0] == kind], EACH)


def judged():
    """(kind, place, sentence, verdict) of the rows of the table."""
    rows = (ROW.match(line) for line in TABLE.read_text().splitlines())
    return [(r[1], r[2], r[3], r[4]) for r in rows if r]


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    for kind, place, sentence in drawn(int(sys.argv[1])):
        print(f"| {kind} | `{place}` | {sentence.replace('|', '/')} | ? |  |")
