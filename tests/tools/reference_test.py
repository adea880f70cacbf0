"""SPARK_REFERENCE_DIR is read at run time; a folder without recordings is an error. Argument: the build folder."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

BUILD = Path(sys.argv.pop(1))
UNSET = object()


def run(command, reference, **options):
    environment = {name: value for name, value in os.environ.items() if name != "SPARK_REFERENCE_DIR"}
    if reference is not UNSET:
        environment["SPARK_REFERENCE_DIR"] = str(reference)
    return subprocess.run(command, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)


class Reference(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = Path(self.folder.name)

    def seen_by_tests(self, reference):
        """The value of the variable in a test with the ctest settings of this build."""
        (self.path / "CTestTestfile.cmake").write_text(f'include("{BUILD}/environment.cmake")\nadd_test(probe sh -c "echo value=$SPARK_REFERENCE_DIR.")\n')
        result = run(["ctest", "-V"], reference, cwd=self.path)
        self.assertEqual(result.returncode, 0, result.stdout)
        return result.stdout.split("value=")[-1].split(".\n")[0]

    def test_the_environment_overrides_the_configuration(self):
        self.assertEqual(self.seen_by_tests("/from/the/environment"), "/from/the/environment")
        self.assertEqual(self.seen_by_tests(""), "")

    def test_without_the_variable_tests_get_the_configured_folder(self):
        cache = (BUILD / "CMakeCache.txt").read_text().splitlines()
        configured = next(line.partition("=")[2] for line in cache if line.startswith("SPARK_REFERENCE_DIR:"))
        self.assertEqual(self.seen_by_tests(UNSET), configured)

    def test_no_test_stores_the_value_at_configuration(self):
        self.assertIn("environment.cmake", (BUILD / "CTestTestfile.cmake").read_text())
        for file in BUILD.rglob("CTestTestfile.cmake"):
            self.assertNotIn("SPARK_REFERENCE_DIR", file.read_text(), file)

    def test_without_the_variable_a_program_is_skipped(self):
        self.assertEqual(run([self.program()], UNSET).returncode, 77)
        self.assertEqual(run([self.program()], "").returncode, 77)

    def test_a_missing_or_empty_folder_is_an_error(self):
        for folder in (self.path / "missing", self.path):
            result = run([self.program()], folder)
            self.assertEqual(result.returncode, 1, result.stdout)
            self.assertIn(f"SPARK_REFERENCE_DIR is '{folder}', where there is no folder captures/", result.stdout)

    def program(self):
        return BUILD / "tests" / "test-monitor-sexp-captures"


if __name__ == "__main__":
    unittest.main()
