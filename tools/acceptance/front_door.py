"""The milestone `front-door`: both commands pass on every machine, and a new user finds the entry points."""
import re
import subprocess
import sys
from collections import Counter

from acceptance import english
from acceptance.common import FAIL, OPEN, PASS, ROOT, last_check, tests
from acceptance.fresh import busy, fresh_clone

PAGES = ROOT / "tests/pages"
LINES = 100
STOPS = 0.1  # share of sentences that may stop a reader

fresh = False  # points 1 and 2 run the commands in a fresh clone


def newcomer():
    if not fresh:
        found = last_check("plain", "all", "long")
        return f"--fresh judges this; last tools/check ({found[0]}): {found[1]}; {found[2][-1]}" if found else "--fresh judges this", OPEN
    with fresh_clone() as clone:
        done = [clone.command("tools/play")]
        clone.forget_what_was_built()
        done.append(clone.command("tools/check"))
        stages = clone.stages("plain")
        clone.forget_what_was_built()
        done.append(clone.command("tools/check", "--all"))
        stages += ["--all:", *clone.stages("all")]
    return "; ".join(map(str, [*done, *stages])), PASS if all(d.passed for d in done) else FAIL


def slow_machine():
    """With existing builds, because only the tests have deadlines."""
    if not fresh:
        return "--fresh judges this", OPEN
    with fresh_clone() as clone:
        built = clone.command("tools/play")
        with busy(2):
            nice = clone.command("tools/check", before=("nice", "-n", "19"))
        pinned = clone.command("tools/check", before=("taskset", "-c", "0"))
        with busy(2):
            both = clone.command("tools/check", before=("nice", "-n", "19", "taskset", "-c", "0"))
    return f"beside two busy loops: {nice}; {pinned}; beside two busy loops: {both}", PASS if built.passed and nice.passed and pinned.passed and both.passed else FAIL


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
    "1": ("both commands in a fresh clone with an empty compiler cache", newcomer),
    "2": ("the tests beside two busy loops, at the lowest priority, on one core", slow_machine),
    "3": ("README, names, pages", readme),
    "4": ("sampled English", sampled_english),
}
