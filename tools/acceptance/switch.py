"""The milestone `switch`: teams come from the installed base without a hitch."""
import os
import re
import subprocess
import tempfile
from pathlib import Path

from acceptance import demo_team, mutants
from acceptance.common import FAIL, OPEN, PASS, ROOT, run, say, tests

SESSIONS = 13
PLAY_SECONDS, CHECK_SECONDS = 240, 2100  # from an empty compiler cache, two idle cores
OTHERS = ("first-match", "robocup3d", "fast", "web")

fresh = False  # builds are timed in a fresh clone with an empty compiler cache


def conformance():
    measured, verdict = tests("conformance-.*")
    count = int(re.match(r"(\d+) of", measured).group(1))
    return f"{measured} ({SESSIONS} sessions wanted)", verdict if verdict != PASS or count == SESSIONS else FAIL


def timed(clone, script, cache):
    """Wall seconds of a script of the clone, with a compiler cache of its own, and whether it passed."""
    say(f"{script} in {clone} with an empty compiler cache")
    start = os.times().elapsed
    done = run([clone / script], env={**os.environ, "CCACHE_DIR": str(cache)})
    return os.times().elapsed - start, done.returncode == 0


def stages():
    if not fresh:
        file = ROOT / "build/check/stages"
        if not file.exists():
            return "tools/check has not run here; --fresh measures from an empty compiler cache", OPEN
        lines = [" ".join(line.split()) for line in file.read_text().splitlines()]
        cold = lines[-1].endswith(" 0 from the compiler cache")
        within = int(re.match(r"sum (\d+) s", lines[-1]).group(1)) <= CHECK_SECONDS
        return f"last tools/check: {'; '.join(lines)}", (PASS if within else FAIL) if cold else OPEN
    with tempfile.TemporaryDirectory() as folder:
        clone = Path(folder) / "spark"
        subprocess.run(["git", "clone", "-q", ROOT, clone], check=True)
        play, played = timed(clone, "tools/play", Path(folder) / "cache-of-play")
        installed = subprocess.run(["cmake", "--install", clone / "build/release", "--prefix", Path(folder) / "installed"], stdout=subprocess.DEVNULL).returncode == 0
        subprocess.run(["rm", "-rf", clone / "build"], check=True)
        check, checked = timed(clone, "tools/check", Path(folder) / "cache-of-check")
        table = "; ".join(" ".join(line.split()) for line in (clone / "build/check/stages").read_text().splitlines())
    good = played and installed and checked and play <= PLAY_SECONDS and check <= CHECK_SECONDS
    measured = (f"tools/play {play:.0f} s (at most {PLAY_SECONDS}), cmake --install {'works' if installed else 'FAILS'}, "
                f"tools/check {check:.0f} s (at most {CHECK_SECONDS}){'' if played and checked else ', FAILED'}: {table}")
    return measured, PASS if good else FAIL


def others():
    verdicts = {}
    for name in OTHERS:
        say(f"tools/accept {name}")
        verdicts[name] = run([ROOT / "tools/accept", name]).returncode == 0
    return ", ".join(f"{name} {'pass' if good else 'FAIL'}" for name, good in verdicts.items()), PASS if all(verdicts.values()) else FAIL


POINTS = {
    "1": ("recorded sessions to the last digit", conformance),
    "2": ("clients of the installed base", lambda: tests("system-clients", "protocol-expect", "monitor-crowd", "system-drop-in")),
    "3": ("cases of the review", lambda: tests("review-.*")),
    "4a": ("two teams of ours", demo_team.point),
    "4b": ("builds from an empty cache", stages),
    "4c": ("killed mutants", mutants.killed_mutants),
    "5": ("earlier milestones", others),
}
