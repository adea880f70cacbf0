"""The milestone `front-door`: both commands pass on every machine, and a new user finds the entry points."""
import re
import subprocess
import sys
from collections import Counter

from acceptance import english
from acceptance.common import FAIL, OPEN, PASS, ROOT, last_check, tests
from acceptance.fresh import newcomer, slow_newcomer

PAGES = ROOT / "tests/pages"
LINES = 100
STOPS = 0.1  # share of sentences that may stop a reader

fresh = False  # points 1 and 2 run the commands in a fresh clone


def both_commands():
    if not fresh:
        found = last_check("plain", "all", "long")
        return f"--fresh judges this; last tools/check ({found[0]}): {found[1]}; {found[2][-1]}" if found else "--fresh judges this", OPEN
    done = newcomer()
    return f"{done.play}; {done.check}; {'; '.join(done.stages)}", PASS if done.play.passed and done.check.passed else FAIL


def slow_machine():
    if not fresh:
        return "--fresh judges this", OPEN
    slow = slow_newcomer()
    return str(slow), PASS if slow.passed else FAIL


def readme():
    lines = len((ROOT / "README.md").read_text().splitlines())
    stale = subprocess.run([sys.executable, PAGES / "index_test.py"], capture_output=True, text=True)
    wrong = re.findall(r"^(?:FAIL|ERROR): (.*)$", stale.stderr, re.MULTILINE)
    followed, verdict = tests("page-.*")
    names = re.search(r"set\(followed_pages ([^)]*)\)", (PAGES / "CMakeLists.txt").read_text())[1].split()
    skipped = [line for name in names for line in
               subprocess.run([sys.executable, PAGES / "follow.py", "--skipped", ROOT / f"{name}.md"], capture_output=True, text=True).stdout.splitlines()]
    measured = (f"README: {lines} lines (at most {LINES}); stale names: {len(wrong)}{' ' + wrong[0] if wrong else ''}; pages followed: {', '.join(names)} ({followed}); "
                f"not followed: {'; '.join(skipped) or 'nothing'}")
    return measured, PASS if lines <= LINES and not wrong and verdict == PASS else FAIL


def sampled_english():
    rows = english.judged()
    counts = {kind: Counter(verdict for k, _, _, verdict in rows if k == kind) for kind in ("product", "tests")}
    measured = "; ".join(f"{kind}: {', '.join(f'{c[v]} {v}' for v in ('clear', 'slows', 'stops'))}" for kind, c in counts.items())
    enough = len(rows) >= 60 and all(sum(c.values()) >= 30 for c in counts.values())
    return f"{measured} (tools/acceptance/english.md; at most {100 * STOPS:.0f} % of each may stop a reader)", \
        PASS if enough and all(c["stops"] <= STOPS * sum(c.values()) for c in counts.values()) else FAIL


POINTS = {
    "1": ("both commands in a fresh clone with an empty compiler cache", both_commands),
    "2": ("the tests at the lowest priority, on one core, beside two busy loops", slow_machine),
    "3": ("README, names, pages", readme),
    "4": ("sampled English", sampled_english),
}
