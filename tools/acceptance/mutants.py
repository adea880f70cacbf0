"""The share of killed mutants in core and physics, on a sample that is always the same; see docs/testing.md."""
import json
import tempfile
from pathlib import Path

from acceptance.common import FAIL, PASS, ROOT, run, say

COUNT, SEED, WANTED = 40, "1", 0.9


def killed_mutants():
    """(measured, verdict): at least nine of ten mutants are killed by the tests nearest to them, and so are all that once survived."""
    with tempfile.TemporaryDirectory() as folder:
        say("Building and testing mutants")
        reports = [Path(folder) / "sample.json", Path(folder) / "named.json"]
        for report, what in zip(reports, (["--count", str(COUNT), "--seed", SEED], ["--named"])):
            if run([ROOT / "tools/mutate", *what, "--json", report]).returncode:
                return f"tools/mutate {' '.join(what)} failed", FAIL
        sample, named = [json.loads(report.read_text()) for report in reports]
    return judged(sample, named)


def judged(sample, named):
    killed, counted = sample["sums"].get("all", (0, 0))
    survived = [f"{m['file']}:{m['line']}" for report in (sample, named) for m in report["mutants"] if m["verdict"] == "survived"]
    again = named["sums"].get("all", (0, 0))
    share = killed / counted if counted else 0
    measured = f"{killed} of {counted} mutants killed ({100 * share:.0f} %, seed {SEED}), {again[0]} of {again[1]} that once survived"
    if survived:
        measured += f"; survived: {', '.join(survived)}"
    return measured, PASS if share >= WANTED and again[0] == again[1] > 0 else FAIL
