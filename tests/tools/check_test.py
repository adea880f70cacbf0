"""tools/check fails when no test ran. Fake ctest and cmake programs give the results that a test needs."""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ONE_TEST = '<testsuite name="x"><testcase name="a" status="run"/></testsuite>'
NO_TEST = '<testsuite name="x" tests="0"/>'


class Check(unittest.TestCase):
    """A tree that holds only the scripts of tools/."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tree = Path(folder.name)
        shutil.copytree(ROOT / "tools", self.tree / "tools", ignore=shutil.ignore_patterns("*.cpp", "__pycache__"))
        self.programs = self.tree / "programs"
        self.programs.mkdir()
        for folder in ("core", "plugins", "tests"):
            (self.tree / folder).mkdir()
        self.program("clang-format-14", "exit 0")
        self.program(self.tree / "tools/lint-words", "exit 0")
        self.program(self.tree / "tools/lint", "exit 0")
        self.program(self.tree / "tests/system/uninitialised", "exit 0")
        self.program(self.tree / "tests/reports/run.py", "exit 0")
        self.program("cmake", "exit 0")
        self.program("dpkg-query", "echo install ok installed")
        self.program("node", "echo true")
        self.program("npm", "exit 0")
        self.program("chromium", "exit 0")
        self.reports(ONE_TEST)
        self.fuzzer("exit 0")

    def program(self, name, text):
        file = self.programs / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(f"#!/bin/sh\n{text}\n")
        file.chmod(0o755)

    def reports(self, text, of="*"):
        """Sets the report of ctest for the presets that `of` matches; the others report one passed test."""
        self.program("ctest", 'while [ $# -gt 0 ]; do case $1 in --preset) preset=$2;; --output-junit) report=$2;; esac; shift; done\n'
                     f"case $preset in {of}) printf '{text}';; *) printf '{ONE_TEST}';; esac >$report")

    def fuzzer(self, text):
        self.program(self.tree / "build/fuzz/bin/fuzz-some", text)

    def check(self, *arguments):
        path = f"{self.programs}:{os.environ['PATH']}"
        return subprocess.run([self.tree / "tools/check", *arguments], env=dict(os.environ, PATH=path), text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def expect(self, code, last, *said, mode="--all"):
        result = self.check(*mode.split())
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(result.stdout.strip().splitlines()[-1], last)
        for text in said:
            self.assertIn(text, result.stderr)

    def stages(self, mode):
        """Names of the stages that were kept."""
        return [line[:14].strip() for line in (self.tree / f"build/check/stages-{mode}").read_text().splitlines()]

    def test_the_plain_check_looks_builds_and_tests(self):
        self.expect(0, "3 passed, 0 failed, 0 skipped", "CPU s; 0 compiled, 0 from the compiler cache", mode="")
        self.assertEqual(self.stages("plain"), ["format", "words", "release build", "release tests", "sum"])
        self.assertEqual((self.tree / "build/check/summary-plain").read_text(), "3 passed, 0 failed, 0 skipped\n")

    def test_all_adds_lint_sanitizers_and_fuzzers(self):
        self.expect(0, "8 passed, 0 failed, 0 skipped", "release build", "asan tests", "fuzz runs")
        self.assertEqual(len(self.stages("all")), 13)

    def test_long_has_the_stages_of_all_and_valgrind(self):
        self.expect(0, "9 passed, 0 failed, 0 skipped", mode="--long")
        self.assertEqual(len(self.stages("long")), 14)

    def test_findings_of_valgrind_are_shown(self):
        self.program(self.tree / "tests/system/uninitialised", "echo 'Use of uninitialised value of size 8'; exit 1")
        self.expect(1, "8 passed, 1 failed, 0 skipped", "Use of uninitialised value of size 8", "valgrind: tests/system/uninitialised", mode="--long")

    def test_time_decides_nothing(self):
        self.program("cmake", "sleep 0.5")  # a slow build
        self.expect(0, "3 passed, 0 failed, 0 skipped", mode="")

    def test_other_options_are_refused(self):
        for mode in ("--fast", "--all --long"):
            result = self.check(*mode.split())
            self.assertEqual(result.returncode, 1)
            self.assertIn("usage: tools/check [--all | --long]", result.stderr)

    def test_a_wrongly_formatted_file_is_named(self):
        self.program("clang-format-14", "echo 'core/kernel/src/a.cpp:3:1: error: code should be clang-formatted' >&2; exit 1")
        self.expect(1, "7 passed, 1 failed, 0 skipped", "format: clang-format-14 -i core/kernel/src/a.cpp")

    def test_a_word_of_soccer_is_shown_with_its_position(self):
        self.program(self.tree / "tools/lint-words", "echo \"core/kernel/src/a.cpp:3: 'ball' is soccer's\"; exit 1")
        self.expect(1, "7 passed, 1 failed, 0 skipped", "core/kernel/src/a.cpp:3: 'ball'", "words: tools/lint-words")

    def test_findings_of_clang_tidy_are_shown(self):
        self.program(self.tree / "tools/lint", "echo 'plugins/a.cpp:3:1: error: copied'; exit 1")
        self.expect(1, "7 passed, 1 failed, 0 skipped", "plugins/a.cpp:3:1: error: copied", "lint: tools/lint")

    def test_a_report_without_tests_is_a_failure(self):
        self.reports(NO_TEST, "asan")
        self.expect(1, "7 passed, 1 failed, 0 skipped", "asan: no test ran")

    def test_no_report_is_a_failure(self):
        self.reports("", "tsan")
        self.expect(1, "7 passed, 1 failed, 0 skipped", "tsan: ctest gave no report")

    def test_skipped_tests_are_counted_as_skipped(self):
        self.reports('<testsuite name="x"><testcase name="a" status="notrun"><skipped/></testcase></testsuite>', "release")
        self.expect(0, "7 passed, 0 failed, 1 skipped")

    def test_a_failing_test_is_named(self):
        self.reports('<testsuite name="x"><testcase name="a" status="fail"><failure/></testcase></testsuite>', "release")
        self.expect(1, "7 passed, 1 failed, 0 skipped", "x: a")

    def test_a_failing_fuzzer_is_named(self):
        self.fuzzer("exit 1")
        self.expect(1, "7 passed, 1 failed, 0 skipped", "fuzz: fuzz-some")

    def test_a_missing_fuzz_program_is_a_failure(self):
        (self.tree / "build/fuzz/bin/fuzz-some").unlink()
        self.expect(1, "7 passed, 1 failed, 0 skipped", "fuzz: there is no program")


class Presets(unittest.TestCase):
    def test_every_preset_fails_without_tests(self):
        presets = json.loads((ROOT / "CMakePresets.json").read_text())["testPresets"]
        self.assertTrue(presets)
        for preset in presets:
            self.assertEqual(preset["execution"]["noTestsAction"], "error", preset["name"])

    def test_ctest_fails_if_no_test_matches(self):
        with tempfile.TemporaryDirectory() as folder:
            presets = json.loads((ROOT / "CMakePresets.json").read_text())
            presets["configurePresets"] = [{"name": p["configurePreset"], "generator": "Ninja", "binaryDir": folder} for p in presets["testPresets"]]
            del presets["buildPresets"]
            (Path(folder) / "CMakePresets.json").write_text(json.dumps(presets))
            (Path(folder) / "CTestTestfile.cmake").write_text("add_test(one true)\n")
            for preset in presets["testPresets"]:
                for wanted, passes in (("one", True), ("nothing", False)):
                    result = subprocess.run(["ctest", "--preset", preset["name"], "-R", wanted], cwd=folder, capture_output=True, text=True)
                    self.assertEqual(result.returncode == 0, passes, result.stdout + result.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
