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

    def lint(self, *files):
        result = subprocess.run([sys.executable, self.script, *[self.tree / f for f in files]], text=True, capture_output=True)
        return result.returncode, [line.split(" is soccer's")[0] for line in result.stdout.splitlines()[:-1]]

    def test_words_from_other_fields_pass(self):
        self.assertEqual(self.lint(), (0, []))

    def test_each_word_is_reported_with_file_and_line_in_any_spelling(self):
        self.write("core/kernel/src/a.cpp", "int a;\nbool isBallNear;\nint kKickOff, free_kick;\n/// The referee's AgentState.\nint BALL;\n")
        code, lines = self.lint()
        self.assertEqual(code, 1)
        self.assertEqual(lines, [f"core/kernel/src/a.cpp:{position}" for position in
                                 ("2: 'ball'", "3: 'kick'", "3: 'kick off'", "3: 'free kick'", "4: 'referee'", "4: 'agent state'", "5: 'ball'")])

    def test_parts_of_longer_words_are_ignored(self):
        self.write("core/kernel/src/a.cpp", "int balloon, goalless, kickstart, footballer; // agent, state; game. state\n")
        self.assertEqual(self.lint(), (0, []))

    def test_soccer_plugins_tests_and_prose_may_use_the_words(self):
        for name in ("plugins/soccer/a.h", "plugins/sphere-team/a.cpp", "tools/agents/a.cpp", "plugins/physics/tests/a.cpp", "plugins/sensors/README.md"):
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
        self.assertEqual(lines, ["tools/lint-words: nothing in plugins/physics/* needs the exception for 'ball'. Delete it."])

    def test_this_tree_passes(self):
        result = subprocess.run([ROOT / "tools/lint-words"], text=True, capture_output=True)
        self.assertEqual((result.returncode, result.stdout), (0, ""))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
