"""The milestone `reports`: what public reports ran into, each row with its input, what is right and what was seen."""
import os
import sys

from acceptance.common import BIN, FAIL, PASS, ROOT, tests
from acceptance.fresh import busy

sys.path.append(str(ROOT / "tests/reports"))
import run as reports  # noqa: E402

ROWS = [*range(1, 16), 25]


def table():
    found = list(reports.run_all(BIN, ROWS, jobs=os.cpu_count() or 1))
    for r in found:
        print(f"{r['row']:>2} | {'right' if r['good'] else 'WRONG'} | {r['case']} {r['engine']}\n     input: {r['input']}\n     right: {r['right']}\n     seen:  {r['seen']}")
    bad = [f"{r['case']} {r['engine']}".strip() for r in found if not r["good"]]
    missing = sorted(set(ROWS) - {r["row"] for r in found})
    measured = f"{len(found) - len(bad)} of {len(found)} runs are right"
    measured += f"; wrong: {', '.join(bad)}" if bad else ""
    measured += f"; rows without a case: {missing}" if missing else ""
    return measured, FAIL if bad or missing else PASS


def sessions():
    """All recorded sessions at once, with the lowest priority beside two busy loops: some ten minutes."""
    with busy(2, apart=False):
        return tests("conformance-.*", before=("nice", "-n", "19"), jobs=100)


POINTS = {
    "1": ("rows 1 to 15 and 25", table),
    "2": ("recorded sessions, all at once beside two busy loops", sessions),
}
