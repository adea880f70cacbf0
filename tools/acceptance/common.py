"""Shared code of all milestones: running programs and tests."""
import os
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
BIN = ROOT / "build/release/bin"
PASS, FAIL, OPEN = "pass", "FAIL", "open"


def say(text):
    print(f"\n== {text}", file=sys.stderr, flush=True)


def run(command, **options):
    """A finished process with its output; stderr is passed through unless it is captured."""
    return subprocess.run([str(c) for c in command], stdout=subprocess.PIPE, text=True, **options)


def build(preset, *targets):
    say(f"Building {preset}")
    subprocess.run(["cmake", "--preset", preset], cwd=ROOT, stdout=sys.stderr, check=True)
    subprocess.run(["cmake", "--build", "--preset", preset, *(["--target", *targets] if targets else [])], cwd=ROOT, stdout=sys.stderr, check=True)


REPORTS = ROOT / "build/check"


def last_check(*modes):
    """(mode, last line, stages) of the latest tools/check here of these modes (plain, all, long), or None."""
    ended = [(file.stat().st_mtime, mode) for mode in modes for file in [REPORTS / f"summary-{mode}"] if file.exists()]
    if not ended:
        return None
    mode = max(ended)[1]
    stages = [" ".join(line.split()) for line in (REPORTS / f"stages-{mode}").read_text().splitlines()]
    return mode, (REPORTS / f"summary-{mode}").read_text().strip(), stages


def tests(*patterns, environment=None, before=(), jobs=1):
    """Runs the ctest programs of the release build whose names match, `jobs` at once; each pattern must match one. `before`: words such as nice."""
    with tempfile.NamedTemporaryFile(suffix=".xml") as report:
        say("Testing " + ", ".join(patterns))
        subprocess.run([*before, "ctest", "--preset", "release", "-j", str(jobs), "-R", "^(" + "|".join(patterns) + ")$", "--output-junit", report.name], cwd=ROOT, stdout=sys.stderr, env={**os.environ, **(environment or {})})
        cases = list(xml.parse(report.name).getroot().iter("testcase"))
    names = [c.get("name") for c in cases]
    skipped = [c.get("name") for c in cases if c.find("skipped") is not None]
    failed = [c.get("name") for c in cases if c.get("status") == "fail"]
    missing = [p for p in patterns if not any(re.fullmatch(p, n) for n in names)]
    measured = f"{len(names) - len(failed) - len(skipped)} of {len(names)} test programs passed"
    for what, which in (("failed", failed), ("skipped", skipped), ("missing", missing)):
        if which:
            measured += f"; {what}: {', '.join(which)}"
    return measured, FAIL if failed or missing else OPEN if skipped else PASS
