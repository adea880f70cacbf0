"""The milestone `switch`: teams come from the installed base without a hitch."""
import re

from acceptance import demo_team, mutants
from acceptance.common import FAIL, OPEN, PASS, ROOT, last_check, run, say, tests
from acceptance.fresh import newcomer

SESSIONS = 13
# CPU time with an empty compiler cache, as a multiple of that of compiling tests/catch_main.cpp.
PLAY_UNITS, CHECK_UNITS = 90, 250
OTHERS = ("first-match", "robocup3d", "fast", "web")

fresh = False  # builds are timed in a fresh clone with an empty compiler cache


def conformance():
    measured, verdict = tests("conformance-.*")
    count = int(re.match(r"(\d+) of", measured).group(1))
    return f"{measured} ({SESSIONS} sessions wanted)", verdict if verdict != PASS or count == SESSIONS else FAIL


def stages():
    """Judged by CPU time as a multiple of a compilation in the same run, so that the machine's speed does not matter."""
    if not fresh:
        found = last_check("plain", "all", "long")
        return f"last tools/check ({found[0]}): {'; '.join(found[2])}" if found else "tools/check has not run here", OPEN
    done = newcomer()
    ratios = done.play.cpu / done.unit, done.check.cpu / done.unit
    measured = (f"{done.play}: {ratios[0]:.0f} x a compilation of {done.unit:.1f} CPU s (at most {PLAY_UNITS}); "
                f"cmake --install {'works' if done.installed else 'FAILS'}; {done.check}: {ratios[1]:.0f} x (at most {CHECK_UNITS}): {'; '.join(done.stages)}")
    good = done.play.passed and done.installed and done.check.passed and ratios[0] <= PLAY_UNITS and ratios[1] <= CHECK_UNITS
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
