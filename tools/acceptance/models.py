"""The milestone `models`: small models in MJCF, URDF and the language of Webots move as in MuJoCo, and what does not is named."""
import re
import subprocess

from acceptance.common import FAIL, OPEN, PASS, ROOT, tests

PROGRAM = ROOT / "build/release/tests/test-models"
AGREE = 0.9  # of all models
ROW = re.compile(r"(\S+\.(?:xml|urdf|wbt)) \| (loads|REFUSED) \| (agrees|DIFFERS) \| (\S+)(?: ([^|]*))? \| (.*?)(?: \[(.*)\])?$")

rows = None


def measure():
    """The rows of the test program, which run once: (file, loads, agrees, worst, where, named in the log, why not)."""
    global rows
    if rows is None:
        run = subprocess.run([PROGRAM], capture_output=True, text=True)
        rows = [m.groups() for line in run.stdout.splitlines() if (m := ROW.match(line))]
        width = max((len(r[0]) for r in rows), default=0)
        for file, loads, agrees, worst, where, named, why in rows:
            reasons = "; ".join(filter(None, [where, why, named]))
            print(f"{file:<{width}} | {loads:<7} | {agrees:<7} | {worst:>7} | {reasons if agrees == 'DIFFERS' else named}")
    return rows


def loads():
    """Models that MuJoCo loads; the test fails on a model that it does not."""
    found = measure()
    good = sum(r[1] == "loads" for r in found)
    refused = [r[0] for r in found if r[1] != "loads"]
    kinds = ", ".join(f"{sum(r[0].endswith(e) for r in found)} {e}" for e in (".xml", ".urdf", ".wbt"))
    measured = f"{good} of {len(found)} load ({kinds})" + (f"; refused: {', '.join(refused)}" if refused else "")
    return measured, PASS if good == len(found) >= 60 and " 0 ." not in f" {kinds}" else FAIL


def agree():
    found = measure()
    good = sum(r[2] == "agrees" for r in found)
    share = good / max(1, len(found))
    measured = f"{good} of {len(found)} agree to 1e-6 ({share:.1%}, at least {AGREE:.0%})"
    return measured, PASS if found and share >= AGREE else FAIL


def named():
    """A model that differs has a row that says why, and the difference is named in the log, or MuJoCo's own when it starts a rounding beside."""
    differ = [r for r in measure() if r[2] == "DIFFERS"]
    unexplained, silent = [r[0] for r in differ if not r[6]], [r[0] for r in differ if not r[5]]
    measured = f"{len(differ)} differ; without a row in expected.txt: {', '.join(unexplained) or 'none'}; neither named in the log nor MuJoCo's own rounding: {', '.join(silent) or 'none'}"
    return measured, FAIL if unexplained else OPEN if silent else PASS


POINTS = {
    "1": ("what MuJoCo loads is loaded", loads),
    "2": ("motions agree", agree),
    "3": ("differences are named", named),
    "4": ("tests of the importer", lambda: tests("models", "scene-mjcf-.*", "scene-urdf.*", "scene-webots.*")),
}
