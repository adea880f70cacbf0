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
RUNS = 5  # of which the median of a ratio counts
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


def median(ratio):
    """(the median of a ratio over RUNS runs, their range as text). Both of its times are measured one after the other,
    so other load changes both."""
    ratios = sorted(ratio(i) for i in range(RUNS))
    return statistics.median(ratios), f"median of {RUNS} runs, {ratios[0]:.3f} to {ratios[-1]:.3f}"


def judge(*good):
    return PASS if all(good) else FAIL


@functools.lru_cache(maxsize=None)
def micro(repetition):
    """CPU times [us] of the micro-benchmarks of one run, by name."""
    say("Measuring: sparkbench --micro")
    output = run([BIN / "sparkbench", "--micro", "--json"])
    benchmarks = json.loads(output.stdout[output.stdout.index("{"):])["benchmarks"]
    return {b["name"].split("/process_time")[0]: b["cpu_time"] for b in benchmarks}


def both_ways(world, repetition):
    """One world in process and over TCP, with one thread and with two."""
    return bench("--only", world, "--threads", "2", repetition=repetition)


def in_process():
    ratio, runs = median(lambda i: row(both_ways("moving22", i), "moving22", "host")["ratio"])
    return f"{ratio:.3f} x raw ODE ({runs})", judge(ratio <= 1.20)


def over_tcp():
    ratio, runs = median(lambda i: row(both_ways("moving22", i), "moving22", "tcp")["ratio"])
    with_two, _ = median(lambda i: row(both_ways("moving22", i), "moving22", "tcp", 2)["ratio"])
    speedup, _ = median(lambda i: row(both_ways("moving22", i), "moving22", "tcp", 2)["speedup"])
    rows = both_ways("moving22", 0)
    one, two = row(rows, "moving22", "tcp"), row(rows, "moving22", "tcp", 2)
    same = one["hash"] == row(rows, "moving22", "host")["hash"]
    hashes = bench("--validate-hash", "--only", "empty,rest22,moving22,heap6,boxes1000")
    differ = [h["world"] for h in hashes if not h["same"]]
    measured = (f"{ratio:.3f} x raw ODE with one thread ({runs}), {with_two:.3f} with two; "
                f"{speedup:.2f} x the cycles/s ({one['cyclesPerSecond']:.0f} to {two['cyclesPerSecond']:.0f}); "
                f"hashes of {len(hashes)} worlds {'differ: ' + ', '.join(differ) if differ else 'unchanged'}, TCP {'as' if same else 'NOT as'} in process")
    return measured, judge(ratio <= 1.35, with_two <= 1.35, speedup >= 1.3, not differ, same)


def at_rest():
    def echoes(i):
        r = row(both_ways("rest22", i), "rest22", "tcp")
        return r["cpuMicros"] / r["agents"] / micro(i)["yardstick/echo"]

    ratio, runs = median(echoes)
    over, host = (row(both_ways("rest22", 0), "rest22", way) for way in ("tcp", "host"))
    each = {r["way"]: r["cpuMicros"] / r["agents"] for r in (over, host)}
    return (f"{ratio:.2f} x an echo ({runs}); {each['tcp']:.1f} us over TCP, sending included, {each['host']:.1f} in "
            f"process, an echo {micro(0)['yardstick/echo']:.2f}"), judge(ratio <= 9)


def loading():
    def cycles(i):
        raw = row(both_ways("moving22", i), "moving22", "raw")["cpuMicros"]
        return bench("--loading", repetition=i)[0]["medianMicros"] / raw

    ratio, runs = median(cycles)
    last = bench("--loading", repetition=0)[0]
    measured = f"{ratio:.3f} of that cycle ({runs}); {last['medianMicros'] / 1000:.2f} ms"
    return f"{measured}, the longest {last['worstMicros'] / 1000:.2f}", judge(ratio <= 0.6)


def spheres():
    def each(n, i):
        rows = bench("--only", "spheres100,spheres1000", "--way", "host", repetition=i)
        return row(rows, f"spheres{n}", "host")["cpuMicros"] / n

    ratio, runs = median(lambda i: each(1000, i) / each(100, i))
    measured = f"{ratio:.2f} x ({runs}); {each(1000, 0):.1f} us for each of 1,000, {each(100, 0):.1f} for each of 100"
    return measured, judge(ratio <= 1.3)


def encoding():
    limits = {"bytes/percepts": 2, "bytes/monitor-full": 100, "bytes/action": 2}
    ratios = {n: median(lambda i: micro(i)[n] / micro(i)["yardstick/copy"])[0] for n in limits}
    measured = ", ".join(f"{n.split('/')[1]} {ratio:.2f} ({micro(0)[n]:.2f} us)" for n, ratio in ratios.items())
    verdict = judge(*(ratios[n] <= most for n, most in limits.items()))
    return f"{measured}; copying {micro(0)['yardstick/copy']:.2f} us; medians of {RUNS} runs", verdict


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
    missing = [title for n, (title, _) in POINTS.items() if n != "10" and title.replace("|", "/") not in text]
    if missing:
        return f"docs/performance.md lacks: {'; '.join(missing)}: run with --write", OPEN
    return "docs/performance.md has a row for each target", PASS


def nothing_worse():
    return tests("conformance-.*", "system-attack", "protocol-.*")


POINTS = {
    "1": (
        "22 moving humanoids in process, all percepts and the monitor stream, one thread: at most 1.20 x raw ODE",
        in_process),
    "2": (
        "over TCP in lockstep: at most 1.35 x raw ODE; two threads at least 1.3 x the cycles/s; hashes unchanged",
        over_tcp),
    "3": ("a sleeping humanoid, percepts encoded and sent over TCP: at most 9 x an echo within this machine", at_rest),
    "4": ("loading a humanoid of a kind seen before: at most 0.6 of a cycle of raw ODE with 22 moving ones", loading),
    "5": ("1,000 sphere agents: each at most 1.3 x one of 100", spheres),
    "6": (
        "percepts of 1.3 kB written, 24 commands read: each at most 2 x copying 64 kB; a full monitor frame: 100 x",
        encoding),
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
