"""The steps of a new user: clones into an empty folder and runs the README's commands with an empty compiler cache."""
import contextlib
import json
import os
import subprocess
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

from acceptance.common import ROOT, run, say

SLOW = ("nice", "-n", "19", "taskset", "-c", "0")


@dataclass
class Done:
    """A command that ended: seconds of wall and CPU time, whether it passed, its last line."""
    name: str
    wall: float
    cpu: float
    passed: bool
    last: str

    def __str__(self):
        return f"{self.name} {self.wall:.0f} s, {self.cpu:.0f} CPU s, {'' if self.passed else 'FAILED, '}{self.last}"


class Clone:
    """A clone of this commit in a folder of its own, with a compiler cache of its own."""

    def __init__(self, folder):
        self.folder, self.tree = Path(folder), Path(folder) / "spark"
        subprocess.run(["git", "clone", "-q", ROOT, self.tree], check=True)

    def command(self, *words, before=()):
        """Runs a script of the clone; `before`: words such as nice that start it."""
        name = " ".join([*before, *words])
        say(f"{name} in {self.tree}")
        start = os.times()
        done = run([*before, self.tree / words[0], *words[1:]], cwd=self.tree, env={**os.environ, "CCACHE_DIR": str(self.folder / "cache")})
        end = os.times()
        cpu = (end.children_user - start.children_user) + (end.children_system - start.children_system)
        lines = done.stdout.strip().splitlines()
        return Done(name, end.elapsed - start.elapsed, cpu, done.returncode == 0, lines[-1] if lines else "no output")

    def installs(self):
        return subprocess.run(["cmake", "--install", self.tree / "build/release", "--prefix", self.folder / "installed"], stdout=subprocess.DEVNULL).returncode == 0

    def forget_what_was_built(self):
        subprocess.run(["rm", "-rf", self.tree / "build", self.folder / "cache"], check=True)

    def stages(self, mode):
        return [" ".join(line.split()) for line in (self.tree / f"build/check/stages-{mode}").read_text().splitlines()]


@contextlib.contextmanager
def fresh_clone():
    with tempfile.TemporaryDirectory() as folder:
        yield Clone(folder)


@contextlib.contextmanager
def busy(loops, apart=True):
    """A context in which this many busy processes run; `apart`: in a separate session, so that priorities do not count where the system groups by session."""
    running = [subprocess.Popen(["sh", "-c", "while :; do :; done"], start_new_session=apart) for _ in range(loops)]
    try:
        yield
    finally:
        for process in running:
            process.kill()
            process.wait()


def unit():
    """CPU seconds of compiling tests/catch_main.cpp once, with as many compilers side by side as there are processors: what the time of
    builds and tests is compared with, so that a slow machine or a busy one is judged like any other."""
    with tempfile.TemporaryDirectory() as folder:
        start = os.times()
        count = len(os.sched_getaffinity(0))
        compilers = [subprocess.Popen(["g++", "-std=c++20", "-O1", "-c", ROOT / "tests/catch_main.cpp", "-o", Path(folder) / f"{i}.o"]) for i in range(count)]
        if any([compiler.wait() for compiler in compilers]):
            raise RuntimeError("tests/catch_main.cpp does not compile")
        end = os.times()
    return (end.children_user - start.children_user + end.children_system - start.children_system) / count


@dataclass
class Newcomer:
    """What the README's commands did in a fresh clone."""
    play: Done           # with an empty compiler cache
    installed: bool      # that cmake --install succeeded
    check: Done          # with an empty compiler cache
    stages: list         # of check, with their times
    unit: float          # CPU seconds of unit(), the mean of before and after


def kept(name, judge):
    """The result of judge(), in terms of JSON. Milestones share it: it is kept for the commit, unless something is uncommitted."""
    commit, changes = (subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()
                       for words in (["rev-parse", "HEAD"], ["status", "--porcelain"]))
    file = ROOT / f"build/newcomer/{commit}-{name}.json"
    if file.exists() and not changes:
        say(f"The fresh clone of this commit was judged before; without {file} it is judged again")
        return json.loads(file.read_text())
    result = judge()
    if not changes:
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps(result, indent=1))
    return result


def newcomer():
    """Runs both commands in a fresh clone, a quarter of an hour."""
    def judge():
        with fresh_clone() as clone:
            before = unit()
            play = clone.command("tools/play")
            installed = clone.installs()
            clone.forget_what_was_built()
            check = clone.command("tools/check")
            return asdict(Newcomer(play, installed, check, clone.stages("plain"), (before + unit()) / 2))
    found = kept("first", judge)
    return Newcomer(**{**found, **{name: Done(**found[name]) for name in ("play", "check")}})


def slow_newcomer():
    """Runs the tests in a fresh clone with the lowest priority, on one processor, beside two busy loops: most of an hour."""
    def judge():
        with fresh_clone() as clone:
            clone.command("tools/play")
            with busy(2):
                return asdict(clone.command("tools/check", before=SLOW))
    return Done(**kept("slow", judge))
