"""The milestone `reports`: what public reports ran into, each row with its input, what is right and what was seen."""
import os
import sys

from acceptance.common import BIN, FAIL, OPEN, PASS, ROOT, tests
from acceptance.fresh import busy

sys.path.append(str(ROOT / "tests/reports"))
import run as reports  # noqa: E402

ROWS = [*range(1, 16), 25]
LATER_ROWS = [*range(16, 25)]


def table(rows):
    found = list(reports.run_all(BIN, rows, jobs=os.cpu_count() or 1))
    for r in found:
        print(f"{r['row']:>2} | {'right' if r['good'] else 'WRONG'} | {r['case']} {r['engine']}\n     input: {r['input']}\n     right: {r['right']}\n     seen:  {r['seen']}")
    bad = [f"{r['case']} {r['engine']}".strip() for r in found if not r["good"]]
    missing = sorted(set(rows) - {r["row"] for r in found})
    measured = f"{len(found) - len(bad)} of {len(found)} runs are right"
    measured += f"; wrong: {', '.join(bad)}" if bad else ""
    measured += f"; rows without a case: {missing}" if missing else ""
    return measured, FAIL if bad or missing else PASS


def later():
    """Rows 16 to 24, and the cases of attacks where they are built."""
    measured, verdict = table(LATER_ROWS)
    if not (ROOT / "tests/hostile").exists():
        return f"{measured}; there are no cases of attacks", FAIL
    attacks, attacked = tests("hostile.*")
    return f"{measured}; attacks: {attacks}", max(verdict, attacked, key=[PASS, OPEN, FAIL].index)


def sessions():
    """All recorded sessions at once, with the lowest priority beside two busy loops: some ten minutes."""
    with busy(2, apart=False):
        return tests("conformance-.*", before=("nice", "-n", "19"), jobs=100)


POINTS = {
    "1": ("rows 1 to 15 and 25", lambda: table(ROWS)),
    "2": ("rows 16 to 24, and the cases of attacks", later),
    "3": ("recorded sessions, all at once beside two busy loops", sessions),
}
