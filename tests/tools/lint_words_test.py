"""tools/lint-words reports words of soccer outside the soccer plugins, and no other words."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


class LintWords(unittest.TestCase):
    """A tree that holds the script and the files of a test."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tree = Path(folder.name)
        self.script = self.tree / "tools/lint-words"
        self.write("tools/lint-words", (ROOT / "tools/lint-words").read_text())
        self.write("plugins/sensors/a.h", "int team = 0;  // of a player in this match; pitch is an angle\n")

    def write(self, name, text):
        file = self.tree / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    def run_script(self, *files):
        command = [sys.executable, self.script, *[self.tree / f for f in files]]
        return subprocess.run(command, text=True, capture_output=True)

    def lint(self, *files):
        """The exit code, and the findings without the explanation that follows them."""
        result = self.run_script(*files)
        return result.returncode, [line.split(" is a word of soccer: ")[0] for line in result.stdout.splitlines()
                                   if " is a word of soccer: " in line or line.startswith("tools/lint-words: ")]

    def test_words_from_other_fields_pass(self):
        self.assertEqual(self.lint(), (0, []))

    def test_each_word_is_named_with_file_and_line_however_it_is_written(self):
        self.write("core/kernel/src/a.cpp",
                   "int a;\nbool isBallNear;\nint kKickOff, free_kick;\n/// The referee's AgentState.\nint BALL;\n")
        code, lines = self.lint()
        self.assertEqual(code, 1)
        self.assertEqual(lines, [f"core/kernel/src/a.cpp:{place}" for place in
                                 ("2: 'ball'", "3: 'kick'", "3: 'kick off'", "3: 'free kick'", "4: 'referee'",
                                  "4: 'agent state'", "5: 'ball'")])

    def test_parts_of_other_words_are_none(self):
        self.write("core/kernel/src/a.cpp",
                   "int balloon, goalless, kickstart, footballer; // agent, state; game. state\n")
        self.assertEqual(self.lint(), (0, []))

    def test_soccer_itself_tests_and_prose_may_say_them(self):
        for name in ("plugins/soccer/a.h", "plugins/sphere-team/a.cpp", "tools/agents/a.cpp",
                     "plugins/physics/tests/a.cpp", "plugins/sensors/README.md"):
            self.write(name, "soccer\n")
        self.assertEqual(self.lint(), (0, []))

    def test_an_exception_applies_to_its_files_and_words_only(self):
        self.write("plugins/physics/joints.h", "JointType::ball\nsoccer\n")
        self.write("plugins/sensors/b.h", "JointType::ball\n")
        self.assertEqual(self.lint(), (1, ["plugins/physics/joints.h:2: 'soccer'", "plugins/sensors/b.h:1: 'ball'"]))
        self.assertEqual(self.lint("plugins/physics/joints.h"), (1, ["plugins/physics/joints.h:2: 'soccer'"]))

    def test_an_unused_exception_is_an_error(self):
        self.write("plugins/physics/joints.h", "JointType::hinge\n")
        code, lines = self.lint()
        self.assertEqual(code, 1)
        self.assertEqual(lines, ["tools/lint-words: nothing in plugins/physics/* needs the exception for 'ball'"])
        last = self.run_script().stdout.splitlines()[-1]
        self.assertEqual(last, "An unneeded exception would hide a later word: "
                               "delete it from EXCEPTIONS in tools/lint-words.")

    def test_findings_come_first_and_then_rule_reason_remedies_and_how_to_check_one_file(self):
        self.write("plugins/sensors/b.h", "int goal;\n")
        self.write("plugins/sensors/c.h", "int foul;\n")
        lines = self.run_script().stdout.splitlines()
        self.assertEqual(lines[:2], ["plugins/sensors/b.h:1: 'goal' is a word of soccer: int goal;",
                                     "plugins/sensors/c.h:1: 'foul' is a word of soccer: int foul;"])
        explanation = lines[2:]
        self.assertEqual(len(explanation), 5)
        for line, said in zip(explanation, ("2 words of soccer", "other games", "plugins/api", "EXCEPTIONS",
                                            "tools/lint-words plugins/sensors/b.h")):
            self.assertIn(said, line)
            self.assertLessEqual(len(line), 120)
        self.assertEqual(self.run_script("plugins/sensors/c.h").stdout.splitlines()[1],
                         "1 word of soccer in code that does not belong to soccer.")

    def test_without_findings_nothing_is_explained(self):
        self.assertEqual(self.run_script().stdout, "")
        self.assertEqual(self.run_script("plugins/sensors/a.h").stdout, "")

    def test_a_named_file_that_may_use_the_words_is_said_to_be_unchecked(self):
        for name, reason in {"plugins/soccer/a.h": "the game",
                             "plugins/physics/tests/a.cpp": "a test, or made by a tool",
                             "docs/a.md": "no source of core, plugins, tools, cmake"}.items():
            self.write(name, "soccer\n")
            result = self.run_script(name)
            self.assertEqual((result.returncode, result.stdout), (0, f"{name} is not checked: {reason}\n"))

    def test_a_named_file_that_is_missing_or_elsewhere_is_an_error(self):
        result = self.run_script("plugins/sensors/none.h")
        self.assertEqual((result.returncode, result.stdout), (2, ""))
        self.assertIn("none.h is no file of this tree", result.stderr)
        self.assertEqual(self.run_script(Path(__file__)).returncode, 2)

    def test_absence_in_a_test_has_a_control(self):
        self.write("plugins/camera/tests/a_test.cpp",
                   'CHECK(text.find("x") != text.npos);\nCHECK(lacks(text, "x", other));\n'
                   'while (text.find("x") == text.npos) wait();\n'
                   'CHECK_THAT(a, Contains("x"));\nif (!Contains("x").match(a)) return;\n')
        self.write("plugins/camera/a.cpp", 'CHECK(text.find("x") == text.npos);\n')
        self.assertEqual((self.run_script().returncode, self.run_script().stdout), (0, ""))
        self.write("tests/unit/a_test.cpp",
                   'CHECK(text.find("x") ==\n      std::string::npos);\nREQUIRE(said(3).find("x") == said.npos);\n'
                   'CHECK_THAT(a, Contains("x") && !Catch::Contains("y"));\n')
        result = self.run_script()
        self.assertEqual((result.returncode, [line.split(": ")[0] for line in result.stdout.splitlines()
                                              if ": an absence without a control: " in line]),
                         (1, ["tests/unit/a_test.cpp:1", "tests/unit/a_test.cpp:3", "tests/unit/a_test.cpp:4"]))
        self.assertIn("tests/absence.h", result.stdout)

    def test_plugins_use_neither_files_nor_libraries_of_tools(self):
        self.write("tools/agents/CMakeLists.txt", "add_library(brain STATIC a.cpp)\n")
        self.write("plugins/camera/CMakeLists.txt",
                   "# tools/agents links it\nspark_plugin(camera LIBRARIES brain-camera)\n")
        self.write("plugins/camera/a.cpp", 'const char* text = "start tools/play";  // tools/agents\n')
        self.assertEqual((self.run_script().returncode, self.run_script().stdout), (0, ""))
        self.write("plugins/camera/CMakeLists.txt", "x(${CMAKE_SOURCE_DIR}/tools/agents)\nx(camera LIBRARIES brain)\n")
        self.write("plugins/camera/a.cpp", '#include "tools/agents/a.h"\n')
        result = self.run_script()
        self.assertEqual((result.returncode, [line.split(": ")[0] for line in result.stdout.splitlines()
                                              if "uses nothing of tools/" in line]),
                         (1, ["plugins/camera/CMakeLists.txt:1", "plugins/camera/CMakeLists.txt:2",
                              "plugins/camera/a.cpp:1"]))

    def test_this_tree_passes(self):
        result = subprocess.run([ROOT / "tools/lint-words"], text=True, capture_output=True)
        self.assertEqual((result.returncode, result.stdout), (0, ""))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
