"""The milestone `fast`: compares every target with a new measurement. The machine should be idle otherwise."""
import functools
import json
import statistics
import subprocess
import tempfile
from datetime import datetime, timezone
from pathlib import Path

from acceptance.common import BIN, FAIL, OPEN, PASS, ROOT, run, say, tests

STEP = 0.02  # s of a cycle
RAW = 3406  # us: a cycle of raw ODE with 22 moving humanoids on the machine for which the targets in microseconds were set
RUNS = 5  # of which the least time counts where a ratio of two times is judged
PAGE = ROOT / "docs/performance.md"
HISTORY = ROOT / "tests/bench/history"
history = False  # whether measurements are stored
BEGIN, END = "<!-- written by tools/accept fast --write -->", "<!-- end of what is written -->"


@functools.lru_cache(maxsize=None)
def bench(*arguments, repetition=0):
    """Rows of one run of sparkbench."""
    say("Measuring: sparkbench " + " ".join(arguments))
    keep = ["--history", HISTORY] if history and not {"--validate-hash", "--realtime", "--loading"} & set(arguments) else []
    output = run([BIN / "sparkbench", "--json", *arguments, *keep])
    if not output.stdout.strip():
        raise RuntimeError("sparkbench " + " ".join(arguments) + " printed nothing")
    return json.loads(output.stdout)


def row(rows, world, way, threads=1):
    return next(r for r in rows if (r["world"], r["way"], r["threads"]) == (world, way, threads))


def least(world, way, *arguments):
    """The least CPU time of a cycle [us] in several runs: what else runs on the machine adds to a measurement and never takes from it."""
    return min(row(bench(*arguments, repetition=i), world, way)["cpuMicros"] for i in range(RUNS))


def judge(*good):
    return PASS if all(good) else FAIL


@functools.lru_cache(maxsize=None)
def slowness():
    """How many times slower raw ODE runs now than on the machine of RAW; 1 if it is faster."""
    return max(1, row(bench("--only", "moving22", "--way", "host"), "moving22", "raw")["cpuMicros"] / RAW)


def within(micros, most):
    """Targets in microseconds are scaled by the speed relative to the machine that they were set for."""
    return micros <= most * slowness()


def at_speed(text):
    return text + (f"; raw ODE is {slowness():.2f} x slower than where the target was set, and so may this be" if slowness() > 1 else "")


def both_ways(world):
    """One world in process and over TCP, with one thread and with two."""
    return bench("--only", world, "--threads", "2")


def in_process():
    host, raw = (least("moving22", way, "--only", "moving22", "--way", "host") for way in ("host", "raw"))
    return f"{host / raw:.3f} x raw ODE ({host:.0f} of {raw:.0f} us, the least of {RUNS} runs each)", judge(host / raw <= 1.10)


def over_tcp():
    rows = both_ways("moving22")
    one, two = row(rows, "moving22", "tcp"), row(rows, "moving22", "tcp", 2)
    same = one["hash"] == row(rows, "moving22", "host")["hash"]
    hashes = bench("--validate-hash", "--only", "empty,rest22,moving22,heap6,boxes1000")
    differ = [h["world"] for h in hashes if not h["same"]]
    measured = (f"{one['ratio']:.3f} x raw ODE with one thread, {two['ratio']:.3f} with two; {two['speedup']:.2f} x the cycles/s ({one['cyclesPerSecond']:.0f} to {two['cyclesPerSecond']:.0f}); "
                f"hashes of {len(hashes)} worlds {'differ: ' + ', '.join(differ) if differ else 'unchanged'}, TCP {'as' if same else 'NOT as'} in process")
    return measured, judge(one["ratio"] <= 1.25, two["ratio"] <= 1.25, two["speedup"] >= 1.3, not differ, same)


def at_rest():
    r = row(both_ways("rest22"), "rest22", "tcp")
    host = row(both_ways("rest22"), "rest22", "host")
    each = r["cpuMicros"] / r["agents"]
    return at_speed(f"{each:.1f} us over TCP, sending included; {host['cpuMicros'] / r['agents']:.1f} us in process"), judge(within(each, 25))


def loading():
    rows = bench("--loading")
    worst = max(r["worstMicros"] for r in rows)
    return at_speed(f"{worst / 1000:.2f} ms the longest, {max(r['medianMicros'] for r in rows) / 1000:.2f} ms the median"), judge(within(worst, 2000))


def spheres():
    each = {n: least(f"spheres{n}", "host", "--only", "spheres100,spheres1000", "--way", "host") / n for n in (100, 1000)}
    return f"{each[1000]:.1f} us for each of 1,000, {each[100]:.1f} us for each of 100, the least of {RUNS} runs: {each[1000] / each[100]:.2f} x", judge(each[1000] <= 1.3 * each[100])


def encoding():
    output = run([BIN / "sparkbench", "--micro", "--json"])
    found = {b["name"].split("/process_time")[0]: b["cpu_time"] for b in json.loads(output.stdout[output.stdout.index("{"):])["benchmarks"]}
    limits = {"bytes/percepts": 3, "bytes/monitor-full": 100, "bytes/action": 3}
    missing = [n for n in limits if n not in found]
    measured = ", ".join(f"{n.split('/')[1]} {found[n]:.2f} us" for n in limits if n in found)
    return at_speed(measured) + (f"; missing: {missing}" if missing else ""), OPEN if missing else judge(*(within(found[n], most) for n, most in limits.items()))


def real_time():
    tested, short = tests(".*steady.*")
    r = bench("--only", "moving22", "--realtime", "60")[0]
    measured = (f"allocations: {tested}; {r['cycles']} cycles: done {r['done']['p50'] / 1000:.2f} ms after they were due in the median, {r['done']['p99.9'] / 1000:.2f} at 99.9 %, "
                f"{r['done']['longest'] / 1000:.2f} the longest; begun {r['late']['p99.9'] / 1000:.2f} ms late at 99.9 %; {r['lateCycles']} lost time")
    return measured, FAIL if short == FAIL else judge(r["done"]["p99.9"] <= 1e6 * STEP)


def solver():
    rows = bench("--only", "moving22,rest22", "--threads", "2", "--solver", "articulated")
    raw, host, two = row(rows, "moving22", "raw"), row(rows, "moving22", "host"), row(rows, "moving22", "host", 2)
    idle = row(rows, "rest22", "tcp", 2)
    faster = raw["solve"] / max(1e-9, host["physics"] - raw["collide"])
    play, serve = 1e6 * STEP / two["wallMicros"], 1e6 * STEP / idle["wallMicros"]
    tested, short = tests("physics-articulated.*", ".*oracle.*")
    measured = (f"{faster:.1f} x faster than dWorldStep ({raw['solve']:.0f} us; the physics phase without collision {host['physics'] - raw['collide']:.0f} us); "
                f"11 against 11, moving, in process, two threads: {play:.1f} x real time; over TCP with idle agents {serve:.1f} x; against dWorldStep: {tested}")
    return measured, FAIL if short == FAIL else judge(faster >= 12, play >= 25, serve >= 10)


def batch(folder, runs, threads, seconds):
    """The result of sparkbatch for some matches of 22 humanoids that play inside the host."""
    results = Path(folder) / f"{len(list(Path(folder).iterdir()))}.csv"
    output = run([BIN / "sparkbatch", "--config", "soccer.lua", "--set", "team=Red Blue", "--set", "Soccer.AutomaticKickOff=true", "--set", "Soccer.WaitBeforeKickOff=2", "--runs", str(runs),
                  "--threads", str(threads), "--duration", str(seconds), "--results", results], stderr=subprocess.DEVNULL)
    return json.loads(output.stdout.strip().splitlines()[-1])


def many_worlds():
    say("Running two worlds, one after the other and side by side")
    with tempfile.TemporaryDirectory() as folder:
        pairs = [(batch(folder, 2, 1, 4), batch(folder, 2, 2, 4)) for _ in range(5)]
        large = batch(folder, 4, 4, 3)
    share = statistics.median(two["realTimeFactor"] / 2 / one["realTimeFactor"] for one, two in pairs)
    cpu = statistics.median(two["simSecondsPerCpuSecond"] / one["simSecondsPerCpuSecond"] for one, two in pairs)
    tested, short = tests("batch-.*", "system-batch")
    measured = (f"side by side a processor does {100 * share:.0f} % of what it does for one world alone ({100 * cpu:.0f} % by CPU time); "
                f"{large['megabytesPerWorld']:.1f} MB for each match of 22 humanoids; {tested}")
    return measured, FAIL if short == FAIL else judge(share >= 0.9, large["megabytesPerWorld"] <= 30, not large["failed"])


def page():
    if not PAGE.exists():
        return "docs/performance.md is not there", FAIL
    text = PAGE.read_text()
    if BEGIN not in text:
        return "docs/performance.md has no place for the table", FAIL
    here = processor() in text
    return f"docs/performance.md has the table of {'this machine' if here else 'another machine: run with --write'}", PASS if here else OPEN


def nothing_worse():
    return tests("conformance-.*", "system-attack", "protocol-.*")


POINTS = {
    "1": ("22 moving humanoids in process, all percepts and the monitor stream, one thread: at most 1.10 x raw ODE", in_process),
    "2": ("over TCP in lockstep: at most 1.25 x raw ODE; two threads at least 1.3 x the cycles/s; hashes unchanged", over_tcp),
    "3": ("a sleeping humanoid, percepts encoded and sent: at most 25 us per cycle", at_rest),
    "4": ("loading a humanoid of a kind seen before: at most 2 ms", loading),
    "5": ("1,000 sphere agents: each at most 1.3 x one of 100", spheres),
    "6": ("percepts of 1.3 kB in 3 us, full monitor frame of 22 humanoids in 100 us, 24 commands parsed in 3 us", encoding),
    "7": ("the step allocates nothing; 22 humanoids in real time: 20 ms at the 99.9th percentile", real_time),
    "8": ("articulated solver at least 12 x faster than dWorldStep, same physics; 25 x real time in process, 10 x over TCP, on two cores", solver),
    "9": ("many worlds: throughput of a processor within 10 % of one world alone; at most 30 MB for each", many_worlds),
    "10": ("docs/performance.md holds the table", page),
    "11": ("nothing got worse: recorded sessions repeat, hostile input harms nobody", nothing_worse),
}


# ---- the page ----

def processor():
    name = next((l.split(":", 1)[1].strip() for l in Path("/proc/cpuinfo").read_text().splitlines() if l.startswith("model name")), "unknown processor")
    cores = run(["nproc"]).stdout.strip()
    return f"{name}, {cores} cores"


def phases():
    """How the time of a cycle is distributed, for the worlds that were measured for the points."""
    parts = ("input", "act", "prepare", "physics", "place", "rule", "sense", "publish")
    lines = ["| world, way, solver | CPU us | x raw ODE | " + " | ".join(parts) + " |", "|---|" + "---:|" * (2 + len(parts))]
    for arguments in (("--only", "moving22", "--threads", "2"), ("--only", "rest22", "--threads", "2"), ("--only", "moving22,rest22", "--threads", "2", "--solver", "articulated")):
        for r in bench(*arguments):
            if r["way"] != "raw" and r["threads"] == 1:
                cells = [f"{r['world']}, {r['way']}, {r['solver']}", f"{r['cpuMicros']:.0f}", f"{r['ratio']:.2f}"] + [f"{r[p]:.0f}" for p in parts]
                lines.append("| " + " | ".join(cells) + " |")
    return lines


def write(rows):
    """Writes the table of this run into the page. It contains only the points that were run."""
    commit = run(["git", "-C", ROOT, "rev-parse", "--short", "HEAD"]).stdout.strip()
    lines = [f"{processor()}; {datetime.now(timezone.utc):%Y-%m-%d}, commit {commit}.", "", "| target | measured | verdict |", "|---|---|---|"]
    lines += [f"| {title.replace('|', '/')} | {measured.replace('|', '/')} | {verdict} |" for title, measured, verdict in rows]
    lines += ["", "Mean wall time of each phase per cycle [us], lower quartile of blocks, one thread:", "", *phases()]
    text = PAGE.read_text()
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    say("Drawing docs/pictures/performance.svg")
    run([BIN / "sparkbench", "--only", "boxes1000,moving22,rest22", "--way", "host", "--solver", "dense,articulated",
         "--chart", ROOT / "docs/pictures/performance.svg"])
    PAGE.write_text(before + BEGIN + "\n" + "\n".join(lines) + "\n" + END + after)
    say(f"Wrote {PAGE}")
