"""The share of killed mutants in the whole product, on a sample that is always the same; see docs/testing.md. It takes hours and goes on where it
stopped: what is judged is in build/mutants; `--fresh` forgets it. Survivors of
an earlier commit are judged again."""
import json
import subprocess
import sys

from acceptance.common import FAIL, PASS, ROOT, say

COUNT, SEED, WANTED, LEAST = 150, "whole", 0.9, 0.75
fresh = False


def judge(name, *words):
    report = ROOT / f"build/mutants/{name}.json"
    if fresh:
        report.unlink(missing_ok=True)
    say("Building and testing mutants")
    if subprocess.run([ROOT / "tools/mutate", *words, "--again", "--json", report], stdout=sys.stderr).returncode:
        raise RuntimeError(f"tools/mutate {' '.join(words)} failed")
    return json.loads(report.read_text())


def survivors(report):
    survived = [f"{m['file']}:{m['line']} ({m['operator']})" for m in report["mutants"] if m["verdict"] == "survived"]
    return f"; survived: {', '.join(survived)}" if survived else ""


def judged(report, count):
    """(measured, verdict): at least nine of ten mutants of the sample are killed, and three of four in each folder."""
    killed, counted = report["sums"].get("all", (0, 0))
    share = killed / counted if counted else 0
    weak = [f"{folder} {k} of {n}" for folder, (k, n) in report["sums"].items() if k < LEAST * n]
    measured = f"{killed} of {counted} mutants killed ({100 * share:.0f} %, seed {SEED})"
    measured += (f"; below {100 * LEAST:.0f} %: {', '.join(weak)}" if weak else "") + survivors(report)
    return measured, PASS if share >= WANTED and not weak and counted >= count > 0 else FAIL


def judged_again(report, count):
    """(measured, verdict): all that once survived are killed."""
    killed, counted = report["sums"].get("all", (0, 0))
    return f"{killed} of {counted} that once survived{survivors(report)}", PASS if killed == counted >= count > 0 else FAIL


def sample():
    return judged(judge("sample", "--count", str(COUNT), "--seed", SEED), COUNT)


def once_survived():
    return judged_again(judge("named", "--named"), 1)


def killed_mutants():
    """Both, as one point of a milestone."""
    rows = [sample(), once_survived()]
    return "; ".join(measured for measured, _ in rows), FAIL if FAIL in [verdict for _, verdict in rows] else PASS


POINTS = {"1": ("mutants of the whole product", sample), "2": ("mutants that once survived", once_survived)}
