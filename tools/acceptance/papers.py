"""The milestone `papers`: every row of docs/papers.md, with the tests that show it."""
import re
import sys

from acceptance.common import BIN, FAIL, OPEN, PASS, ROOT, run, say
from acceptance.common import tests as ctest

PAGE = ROOT / "docs/papers.md"
TEST = re.compile(r'`(test-[a-z0-9-]+|browser-[a-z-]+|page-[a-z-]+|reports)(?: "([^"]+)")?`')


def sections():
    """(title, rows) of the page; a row is (claim, tests), each test a program and a pattern of its cases, `reports` and a case
    of tests/reports, or a story of the browser or a page and ""."""
    found = []
    for line in PAGE.read_text().splitlines():
        if line.startswith("## "):
            found.append((line[3:], []))
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if found and line.startswith("| ") and len(cells) == 4 and cells[0] != "claim":
            found[-1][1].append((cells[0], TEST.findall(cells[3])))
    return found


def shown(program, pattern):
    """True if the pattern names cases of the program and all of them pass, or if the story passes or cannot run here. A
    comma would end a pattern of Catch2."""
    if not pattern:
        return ctest(program)[1] != FAIL
    say(f'{program} "{pattern}"')
    if program == "reports":
        return run([sys.executable, ROOT / "tests/reports/run.py", "--bin", BIN, pattern], cwd=ROOT).returncode == 0
    tests = BIN.parent / "tests"
    done = run([tests / program, pattern.replace(",", "\\,"), "--warn", "NoTests"], cwd=ROOT)
    return done.returncode == 0


def judge_section(rows):
    failed, without, cases = [], [], 0
    for claim, tests in rows:
        cases += len(tests)
        if not tests:
            without.append(claim)
        elif not all([shown(*test) for test in tests]):
            failed.append(claim)
    measured = f"{len(rows) - len(failed) - len(without)} of {len(rows)} claims are shown, by {cases} tests"
    for word, claims in (("not shown", failed), ("open", without)):
        if claims:
            measured += f"; {word}: {'; '.join(claims)}"
    return measured, FAIL if failed else OPEN if without else PASS


POINTS = {title.lower(): (f"the papers on {title.lower()}", lambda rows=rows: judge_section(rows)) for title, rows in sections()}
