"""The demo team against itself: goals, time on the ground, and how its five types get up. The match is demo_team.lua beside this file."""
import csv
import tempfile
from pathlib import Path

from acceptance.common import BIN, FAIL, PASS, ROOT, run, say

SEEDS, WANTED_GOALS, MOST_ON_GROUND = 10, 2, 0.05
TYPES = range(5)


def point():
    """(measured, verdict): ten matches of 2 x 300 s with all five types and the foul rules on."""
    say(f"Playing {SEEDS} matches of two teams of ours; some 800 s of CPU time")
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder) / "matches.csv"
        done = run([BIN / "sparkbatch", "--config", ROOT / "tools/acceptance/demo_team.lua", "--runs", str(SEEDS), "--seed", "1", "--results", table])
        if done.returncode:
            return f"sparkbatch ended with {done.returncode}", FAIL
        return judged(list(csv.DictReader(table.open())))


def judged(rows):
    def total(column):
        return sum(float(row[column]) for row in rows)

    goals = (total("scoreLeft") + total("scoreRight")) / len(rows)
    ground = total("groundSeconds") / total("playerSeconds")
    scores = ", ".join(f"{row['seed']}: {row['scoreLeft']}:{row['scoreRight']}" for row in rows)
    measured = f"{goals:.1f} goals a match ({scores}), {100 * ground:.1f} % of player seconds on the ground, {total('fouls') / len(rows):.1f} fouls a match"
    able = True
    for t in TYPES:
        falls, ups = total(f"falls{t}"), total(f"ups{t}")
        measured += f"; type {t}: fell {falls:.0f} times, stood up {ups:.0f} times"
        if ups:
            measured += f" in {total(f'upSeconds{t}') / ups:.1f} s, {max(float(row[f'longest{t}']) for row in rows):.1f} at most"
        able = able and (falls == 0 or ups > 0)
    ended = len(rows) == SEEDS and all(row["playMode"] == "GameOver" for row in rows)
    return measured, PASS if ended and able and goals >= WANTED_GOALS and ground < MOST_ON_GROUND else FAIL
