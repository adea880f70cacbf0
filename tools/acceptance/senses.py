"""The milestone `senses`: rays, occlusion, distance sensors, models of imperfect sensors, pictures of cameras."""
import json
import re

from acceptance.common import BIN, PASS, FAIL, OPEN, run, say, tests

PICTURES = 50  # a second
RAYS_MICROS = 1000  # of 22 x 64 rays, with what prepares for them


def micro(name):
    """The least CPU time of some runs of a micro-benchmark [us], and its counters."""
    say(f"Measuring: sparkbench --micro, {name}")
    runs = []
    for _ in range(3):
        output = run([BIN / "sparkbench", "--micro", "--json"]).stdout
        runs += [b for b in json.loads(output[output.index("{"):])["benchmarks"] if b["name"].split("/process_time")[0] == name]
    return min(runs, key=lambda b: b["cpu_time"])


def rays():
    found = micro("rays/22x64")
    return f"{found['cpu_time']:.0f} us for {found['rays']:.0f} rays, {found['met']:.0f} of which meet something", PASS if found["cpu_time"] <= RAYS_MICROS else FAIL


def occlusion():
    done = run([BIN.parent / "tests/test-physics-parts", "what rays call hidden*", "--warn", "NoTests"])
    words = [line.strip() for line in done.stdout.splitlines() if "points are hidden" in line]
    seen, good = tests("scenario-senses", "soccer")
    return f"{'; '.join(words)}; {seen}", FAIL if done.returncode or not words else good


def distances():
    return tests("sensors")


def modifiers():
    return tests("modifiers")


def pictures():
    seen, good = tests("camera", "camera-pictures", "camera-client")
    say('test-camera "[.measure]"')
    output = run([BIN.parent / "tests/test-camera", "[.measure]"], cwd=BIN.parent).stdout  # it leaves its pictures there
    rates = {f"{name} {kind}": float(rate) for name, kind, rate in re.findall(r"^(\S+) +(\S+) +drawn +([0-9.]+)/s", output, re.MULTILINE)}
    slowest = min(rates, key=rates.get) if rates else None
    measured = f"{seen}; {len(rates)} kinds of pictures of 320 x 240: {rates[slowest]:.0f}/s ({slowest}) to {max(rates.values()):.0f}/s" if rates else seen
    return measured, good if rates and rates[slowest] >= PICTURES else FAIL if rates else OPEN


POINTS = {
    "1": ("22 x 64 rays within 1 ms", rays),
    "2": ("occlusion as a search without rays finds it, in 10,000 random scenes", occlusion),
    "3": ("distance sensors meet the geometry of the scene", distances),
    "4": ("each model of an imperfect sensor has its statistics", modifiers),
    "5": (f"pictures of a camera against references; at least {PICTURES} a second of 320 x 240", pictures),
}
