"""A copy of the tree, built as the release is, in which one mutant at a time is built and tested.

The build is that of the preset `release`, at the same place below its root: nearly all objects come out of the compiler cache, where they are from
tools/check. A mutant in C++ compiles the unity objects of its file (15 s of CPU; a build with an object for each file would take 5 s for a mutant,
and 40 minutes before the first), and taking it back costs nothing, for the cache has the object of before."""
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from mutation.operators import apply
from mutation.product import ROOT, all_files
from mutation.suite import Suite

PLACE = ROOT / "build/mutants"
LEAST_TIMEOUT = 20  # s
UNKNOWN_TIMEOUT = 300  # s, of a test that has not run without a mutant
SKIPPED = 77  # exit code
MOST_NEAR = 8  # tests that are run one after the other
MEMORY = 16 << 30  # bytes of address space for a program of tests
COST = "Testing/Temporary/CTestCostData.txt"  # what tests took in the checkout


class Bench:
    def __init__(self, jobs=2, tree=PLACE / "tree", far=True):
        self.jobs, self.tree, self.build_folder, self.far = jobs, tree, tree / "build/release", far
        self.known_file = tree / "build/tests.json"
        self.known = {}  # {test: seconds that it takes without a mutant, or why it fails then}
        self.hints = {}  # {test: seconds, as it seems}
        self.suite = None
        self.running = []

    # ---- the tree and its build ----

    def prepare(self):
        self.copy()
        query = self.build_folder / ".cmake/api/v1/query/codemodel-v2"
        query.parent.mkdir(parents=True, exist_ok=True)
        query.touch()
        if not (self.build_folder / ".cmake/api/v1/reply").is_dir():
            subprocess.run(["cmake", "--preset", "release", "-DCMAKE_LINK_DEPENDS_NO_SHARED=ON"], cwd=self.tree, stdout=subprocess.DEVNULL, check=True)
        elif not self.build(["build.ninja"], sys.stderr):  # CMake runs again if it has to
            raise SystemExit("CMake failed")
        if not self.build({"plugins", "programs"}, sys.stderr):  # tests warn of plugins that were built with other headers
            raise SystemExit("the tree does not build without a mutant")
        self.suite = Suite(self.tree, self.build_folder)
        for file in (ROOT / "build/release" / COST, self.build_folder / COST):
            for line in file.read_text().split("---")[0].splitlines() if file.exists() else []:
                name, _, seconds = line.split()
                self.hints[name] = float(seconds)
        if self.known_file.exists():
            self.known = json.loads(self.known_file.read_text())

    @staticmethod
    def identity():
        """The commit, and whether the tree differs from it."""
        run = lambda *words: subprocess.run(["git", *words], cwd=ROOT, stdout=subprocess.PIPE, text=True).stdout.strip()
        return run("rev-parse", "--short", "HEAD") + ("+" if run("status", "--porcelain", "-uno") else "")

    def copy(self):
        """Copies the checkout, including untracked files that are not ignored; unchanged files keep their time."""
        wanted = set(all_files())
        self.tree.mkdir(parents=True, exist_ok=True)
        known = subprocess.run(["find", ".", "-path", "./build", "-prune", "-o", "-type", "f", "-printf", "%P\\0"], cwd=self.tree, stdout=subprocess.PIPE,
                               text=True, check=True).stdout
        for old in set(known.split("\0")) - wanted - {""}:
            (self.tree / old).unlink()
        for f in wanted:
            to = self.tree / f
            if not to.exists() or to.read_bytes() != (ROOT / f).read_bytes():
                to.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(ROOT / f, to)
                shutil.copymode(ROOT / f, to)

    def build(self, targets, output=subprocess.DEVNULL, mutant=False):
        """Mutants' objects are not kept in the compiler cache."""
        if not targets:
            return True  # a config
        environment = {**os.environ, **({"CCACHE_READONLY": "1"} if mutant else {})}
        return subprocess.run(["ninja", "-C", self.build_folder, f"-j{self.jobs}", *sorted(targets)], env=environment, stdout=output,
                              stderr=subprocess.STDOUT).returncode == 0

    # ---- tests ----

    def seconds(self, test):
        known = self.known.get(test)
        return known if isinstance(known, float) else self.hints.get(test, 1.0)

    def timeout(self, test):
        return max(LEAST_TIMEOUT, 10 * self.known[test]) if isinstance(self.known.get(test), float) else max(UNKNOWN_TIMEOUT, 10 * self.seconds(test))

    def fails(self, test, timeout):
        """Returns why the test failed, or None."""
        def limits():
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            if test.program:  # an engine of JavaScript reserves more
                resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        process = subprocess.Popen(test.command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=test.cwd or self.build_folder,
                                   env={**os.environ, **test.environment}, start_new_session=True, preexec_fn=limits)
        self.running.append(process)
        try:
            code = process.wait(timeout)
        except subprocess.TimeoutExpired:
            return "runs into its time-out"
        finally:
            self.running.remove(process)
            self.kill(process)
            process.wait()
        return None if code in (0, SKIPPED) else f"ends by signal {-code}" if code < 0 else "fails"

    @staticmethod
    def kill(process):
        try:
            os.killpg(process.pid, signal.SIGKILL)  # with its child processes
        except ProcessLookupError:
            pass

    def is_sound(self, test):
        """Builds the test without a mutant, and runs it, once: whether it passes."""
        if test.name not in self.known:
            if not self.build(self.targets([test])):
                raise SystemExit(f"test {test.name} does not build without a mutant")
            begun = time.monotonic()
            why = self.fails(test, 10 * UNKNOWN_TIMEOUT)
            self.known[test.name] = why or time.monotonic() - begun
            if why:
                print(f"test {test.name} {why} without a mutant and is not asked", file=sys.stderr, flush=True)
            self.known_file.parent.mkdir(parents=True, exist_ok=True)
            self.known_file.write_text(json.dumps({t: s for t, s in self.known.items() if isinstance(s, float)}, indent=1))
        return isinstance(self.known[test.name], float)

    # ---- a mutant ----

    def judge(self, mutant):
        """(verdict, test that killed it): killed, survived or broken (does not compile). A test that kills has to pass without the mutant;
        one of the nearest that does not ends the run."""
        near, far = self.suite.rings(mutant.file)
        near = sorted(near, key=lambda t: self.seconds(t.name))
        near, far = near[:MOST_NEAR], near[MOST_NEAR:] + far
        while True:
            verdict, killer = self.attempt(mutant, near, far)
            if not killer or self.is_sound(killer):
                return verdict, killer and killer.name
            if killer in near:
                raise SystemExit(f"test {killer.name}, one of the nearest to {mutant.file}, fails without a mutant")

    def attempt(self, mutant, near, far):
        near, far = ([t for t in ring if not isinstance(self.known.get(t.name), str)] for ring in (near, far))
        with Changed(self.tree / mutant.file, mutant):
            if not self.build(self.targets(near) | set(self.suite.targets_of(mutant.file)), mutant=True):
                return "broken", None
            for test in near:
                if self.fails(test, self.timeout(test.name)):
                    return "killed", test
            if not self.far:
                return "survived", None
            if not self.build(self.targets(far), mutant=True):
                return "broken", None
            killer = self.first_failure(far)
        return ("killed", killer) if killer else ("survived", None)

    def first_failure(self, tests):
        """The first test seen to fail, twice: far tests have programs that talk to each other, and a neighbour's load is no fault."""
        found = []

        def ask(test):
            for _ in range(2):
                if found or not self.fails(test, self.timeout(test.name)):
                    return
            if not found:
                found.append(test)
                for process in list(self.running):
                    self.kill(process)

        with ThreadPoolExecutor(self.jobs) as pool:
            list(pool.map(ask, tests))
        return found[0] if found else None

    @staticmethod
    def targets(tests):
        return {target for test in tests for target in test.needs}


class Changed:
    """The mutant is in its file while this lives."""

    def __init__(self, file, mutant):
        self.file, self.mutant = file, mutant

    def __enter__(self):
        self.original = self.file.read_text()
        self.file.write_text(apply(self.mutant, self.original))

    def __exit__(self, *_):
        self.file.write_text(self.original)
