"""The milestone `engines`: a contract for engines in the terms of the field, and engines that fulfil it."""
import json
import re
import shutil
import subprocess

from acceptance.common import FAIL, PASS, ROOT, say, tests
from acceptance.fresh import busy

BUILD = ROOT / "build/release"
EXAMPLE = ROOT / "tests/fixtures/plugins/point_masses.cpp"
EXAMPLE_LINES = 150


def suite():
    measured, verdict = tests("engines", "oracle-.*", "physics-ode", "physics-articulated")
    say("writing docs/engines.md")
    table = subprocess.run([BUILD / "tests/test-engines", "[.table]"]).returncode == 0
    names = re.findall(r"\w+Engine(?= \|)", (ROOT / "docs/engines.md").read_text()) if table else []
    mujoco = "MujocoEngine" in names
    return (f"{measured}; docs/engines.md has {', '.join(names)}{'' if mujoco else '; MuJoCo was not found'}",
            PASS if verdict == PASS and table and mujoco else FAIL)


def example():
    """The example engine runs boxes.lua: the boxes fall, and rest on the ground at the end."""
    lines = len(EXAMPLE.read_text().splitlines())
    run = subprocess.run([BUILD / "bin/sparkhost", "--config", "boxes.lua", "--plugin-path", BUILD / "tests/engine-plugins", "--set", "engine=PointMassEngine",
                          "--set", "web=false", "--rate", "max", "--duration", "10"], capture_output=True, text=True)
    end = json.loads(run.stdout.splitlines()[-1]) if run.returncode == 0 else {}
    good = lines <= EXAMPLE_LINES and end.get("cycles") == 500 and end.get("faults") == 0
    return f"{lines} lines; boxes.lua: {end.get('cycles')} cycles, {end.get('faults')} faults, exit code {run.returncode}", PASS if good else FAIL


def t1():
    """The trajectories, from the lines that the test prints."""
    run = subprocess.run([BUILD / "tests/test-scene-mjcf-trajectory"], capture_output=True, text=True)
    found = re.findall(r"(2 s standing|1 s moving): largest difference (\S+) m or rad", run.stdout)
    figures = "; ".join(f"{what}: {float(distance):.1e} m and rad" for what, distance in found)
    good = run.returncode == 0 and len(found) == 2 and all(float(d) <= 1e-9 for _, d in found)
    today, same = mujoco_of_today()
    return f"{figures} (at most 1e-9 wanted); {today}", PASS if good and same else FAIL


# A current MuJoCo in WebAssembly, as a second reference if Node.js is available.
TODAY = "@mujoco/mujoco@3.9.0"


def mujoco_of_today():
    """(measured value, whether it agrees or is unavailable): the largest difference of a joint's angle at the end."""
    if not shutil.which("npm"):
        return "no Node.js for the second oracle", True
    folder = ROOT / "build/mujoco-wasm"
    if not (folder / "node_modules/@mujoco/mujoco").exists():
        folder.mkdir(parents=True, exist_ok=True)
        if subprocess.run(["npm", "install", "--silent", "--prefix", folder, TODAY]).returncode != 0:
            return f"{TODAY} could not be installed", True
    own = subprocess.run([BUILD / "tests/test-scene-mjcf-trajectory", "[.angles]"], capture_output=True, text=True)
    texts, worst = [], 0
    for line in own.stdout.splitlines():
        if not line.startswith("{"):
            continue
        ours = json.loads(line)
        run = subprocess.run(["node", ROOT / "plugins/scene-mjcf/tests/second_oracle.mjs", folder,
                              ROOT / "scenes/robots/t1.xml", ours["motion"]], capture_output=True, text=True)
        if run.returncode != 0:
            return f"the second oracle failed: {run.stderr[-200:]}", False
        theirs = json.loads(run.stdout)["angles"]
        distance = max(abs(angle - theirs[name]) for name, angle in ours["angles"].items())
        worst = max(worst, distance)
        texts.append(f"{ours['motion']} {distance:.1e}")
    return f"{TODAY}: {', '.join(texts)} rad (at most 1e-6)", len(texts) == 2 and worst <= 1e-6


MOST_ABOVE_MUJOCO = 1.15
CYCLE_MS = 20


def joining():
    """Longest cycles while a T1 joins 22 in real time: alone, beside a busy loop, and with a low priority beside it."""
    out = {}
    for name, loops, before in (("alone", 0, ()), ("beside a busy loop", 1, ()), ("with nice 10 beside it", 1, ("nice", "-n", "10"))):
        with busy(loops):
            run = subprocess.run([*before, BUILD / "tests/test-scene-mjcf-trajectory", "[.join]"], capture_output=True, text=True)
        found = [json.loads(line) for line in run.stdout.splitlines() if line.startswith("{")]
        out[name] = found[0]["join_ms"] if found else float("inf")
        say(f"a T1 joins 22 {name}: {found}")
    return out


def cost():
    run = subprocess.run([BUILD / "tests/test-scene-mjcf-trajectory", "[.cost]"], capture_output=True, text=True)
    rows = [json.loads(line) for line in run.stdout.splitlines() if line.startswith("{")]
    for r in rows:
        say(f"{r['engine']:18} {r['robots']:3} T1: {r['cost']:7.0f} us a cycle of 20 ms, {r['ratio']:.2f} x mj_step; "
            f"first cycle {r['first_ms']:.0f} ms, longest when one more joins {r['join_ms']:.1f} ms; "
            f"distance after 1.2 s: {r['distance']:.2g} rad")
    crowds = {r["robots"]: r["ratio"] for r in rows if r["engine"] == "MujocoEngine" and r["robots"] > 1}
    other = {r["robots"]: r["ratio"] for r in rows if r["engine"] == "ArticulatedEngine" and r["robots"] > 1}
    joins = joining()
    join = max(joins.values())
    near = all(ratio <= MOST_ABOVE_MUJOCO for ratio in crowds.values())
    good = run.returncode == 0 and len(crowds) == 2 and near and join < CYCLE_MS
    text = ", ".join(f"{n} T1 {ratio:.2f} x" for n, ratio in crowds.items())
    fast = ", ".join(f"{n} T1 {1 / ratio:.1f} times as fast" for n, ratio in other.items())
    report = (f"physics-mujoco: {text} plain mj_step (at most {MOST_ABOVE_MUJOCO}), longest cycle when one joins 22 in real time: "
              f"{', '.join(f'{ms:.1f} ms {name}' for name, ms in joins.items())} (below {CYCLE_MS}); physics-articulated: {fast}")
    return report, PASS if good else FAIL


def promises():
    sessions, repeated = tests("conformance-.*")
    hashes, same = tests("golden", "bench-hashes")
    return f"sessions: {sessions}; hashes: {hashes}; the rest: tools/accept fast robocup3d first-match", PASS if repeated == same == PASS else FAIL


POINTS = {
    "1": ("one suite over all engines, and the table that it writes", suite),
    "2": ("a T1 from its file has MuJoCo's own trajectory", t1),
    "3": ("14 and 22 T1: cost above plain mj_step, and in physics-articulated", cost),
    "4": ("a third engine, written from the header alone, runs boxes.lua", example),
    "5": ("what was promised before holds", promises),
}
