"""tools/mutate: its changes, draws and counts, and that it restores the files."""
import importlib.machinery
import importlib.util
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
loader = importlib.machinery.SourceFileLoader("mutate", str(ROOT / "tools/mutate"))
spec = importlib.util.spec_from_loader("mutate", loader)
mutate = importlib.util.module_from_spec(spec)
sys.modules["mutate"] = mutate
sys.dont_write_bytecode = True
loader.exec_module(mutate)
sys.path.insert(0, str(ROOT / "tools"))
from acceptance import mutants  # noqa: E402


class Changes(unittest.TestCase):
    def changed(self, line, *expected):
        self.assertEqual(sorted(mutate.changes(line)), sorted(expected))

    def test_one_operator_at_a_time(self):
        self.changed("  a = b < c && d == e;", "  a = b <= c && d == e;", "  a = b < c || d == e;", "  a = b < c && d != e;")
        self.changed("  x = y + z - 2;", "  x = y - z - 2;", "  x = y + z + 2;", "  x = y + z - 3;")
        self.changed("  x = std::min(a, b);", "  x = std::max(a, b);")

    def test_constants_are_changed_by_one(self):
        self.changed("  double x = 0.5;", "  double x = 1.5;")
        self.changed("  x = v1[3];", "  x = v1[4];")
        self.changed("  x = true;", "  x = false;")

    def test_conditions_are_negated(self):
        self.changed("  if (ready(x)) return;", "  if (!(ready(x))) return;")
        self.changed("  if (const auto* p = find()) {")

    def test_calls_are_removed_and_functions_return_early(self):
        self.changed("  body.wake(x);", "  ;")
        self.changed("  Type name(x);")
        self.changed("void World::apply() {", "void World::apply() { return;")
        self.changed("  return place(x);", "  return {};")
        self.changed("  return {};")

    def test_comments_strings_and_declarations_are_unchanged(self):
        for line in ("  // a < b", "#include <x>", '  text("a < b && 1");'.replace("text", "auto t"), "  static_assert(a == 1);", "  prefetch(x + 1);", ""):
            self.changed(line)
        self.changed('  x = f("1 < 2", a < b);  // 1 + 1', '  x = f("1 < 2", a <= b);  // 1 + 1')

    def test_template_brackets_are_unchanged(self):
        self.changed("  std::vector<int> x;")


class Draw(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        (self.root / "core/kernel/src").mkdir(parents=True)
        self.file = "core/kernel/src/a.cpp"
        self.write("".join(f"  x{i} = y + {i};\n" for i in range(20)))

    def write(self, text):
        (self.root / self.file).write_text(text)

    def draw(self, seed="1"):
        return mutate.drawn([self.file], seed, self.root)

    def test_the_draw_depends_on_the_seed(self):
        self.assertEqual(self.draw(), self.draw())
        self.assertNotEqual(self.draw("1"), self.draw("2"))
        self.assertEqual(len(self.draw()), 20)  # one per line

    def test_a_change_elsewhere_does_not_change_the_draw(self):
        before = [(m.before, m.after) for m in self.draw()]
        self.write("int z() { return 7; }\n\n" + (self.root / self.file).read_text())
        self.assertEqual([(m.before, m.after) for m in self.draw() if "z()" not in m.before], before)


class Judge(unittest.TestCase):
    """The bench with fake builds and tests."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tree = Path(folder.name)
        (self.tree / "core/kernel/src").mkdir(parents=True)
        self.file = self.tree / "core/kernel/src/a.cpp"
        self.file.write_text("one < 1;\nok();\nlast();\n")
        self.bench = mutate.Bench(["core/kernel/src"], tree=self.tree, build=self.tree / "build")
        tests = self.tree / "build/tests"
        tests.mkdir(parents=True)
        for i, name in enumerate(mutate.NEAREST["core/kernel/src"][1]):
            self.bench.seconds[name] = i + 1.0
            self.program(name, "exit 0")
        self.bench.build = lambda folder: "broken" not in self.file.read_text()
        self.addCleanup(setattr, mutate, "LEAST_TIMEOUT", mutate.LEAST_TIMEOUT)
        mutate.LEAST_TIMEOUT = 3600  # what is quick is never too slow

    def program(self, test, text):
        file = self.tree / f"build/tests/test-{test}"
        file.write_text(f"#!/bin/sh\n{text}\n")
        file.chmod(0o755)

    def judge(self, after):
        before = self.file.read_text()
        verdict = self.bench.judge(mutate.Mutant("core/kernel/src/a.cpp", 1, "one < 1;", after))
        self.assertEqual(self.file.read_text(), before)
        return verdict

    def test_a_mutant_that_no_test_notices_survives(self):
        self.assertEqual(self.judge("one <= 1;"), ("survived", None))

    def test_the_fastest_failing_test_kills(self):
        self.program("core-tree", f"! grep -q '<=' {self.file}")
        self.program("lua", "exit 1")
        self.assertEqual(self.judge("one <= 1;"), ("killed", "core-tree"))

    def test_a_crash_kills(self):
        self.program("lua", "kill -SEGV $$")
        self.assertEqual(self.judge("one <= 1;"), ("killed", "lua"))

    def test_a_timeout_kills_and_ends_all_child_processes(self):
        self.program("lua", "sleep 1000 & wait")
        mutate.LEAST_TIMEOUT = 0.2
        self.bench.seconds["lua"] = 0.01  # it comes first
        self.assertEqual(self.judge("one <= 1;"), ("killed", "lua"))

    def test_a_mutant_that_does_not_compile_is_replaced_by_another(self):
        texts = ["broken;", "one <= 1;", "one > 1;", "never reached;"]
        drawn = [mutate.Mutant("core/kernel/src/a.cpp", 1, "one < 1;", t) for t in texts]
        rows = mutate.judged(self.bench, drawn, 1, {("core/kernel/src/a.cpp", "one < 1;", "one <= 1;")})
        self.assertEqual([r["verdict"] for r in rows], ["broken", "equivalent", "survived"])
        self.assertEqual(mutate.summary(rows), {"core/kernel/src": [0, 1], "all": [0, 1]})


class Lists(unittest.TestCase):
    def test_named_mutants_apply_to_the_tree(self):
        blocks = mutate.read_list(ROOT / "tools/mutate.named")
        self.assertGreaterEqual(len(blocks), 6)
        for file, before, after, why in blocks:
            mutant = mutate.named(file, before, after)
            text = (ROOT / file).read_text()
            self.assertNotEqual(mutate.apply(mutant, text), text)
            self.assertTrue(why)
            mutate.folder_of(file)

    def test_equivalent_mutants_apply_to_the_tree_and_have_a_reason(self):
        for file, before, after, why in mutate.read_list(ROOT / "tools/mutate.equivalent"):
            lines = [line.strip() for line in (ROOT / file).read_text().split("\n")]
            self.assertIn(before, lines)
            self.assertIn(after, [m.strip() for line in (ROOT / file).read_text().split("\n") if line.strip() == before for m in mutate.changes(line)])
            self.assertGreater(len(why), 15)


class Verdict(unittest.TestCase):
    def report(self, killed, counted):
        rows = [{"file": "a.cpp", "line": i, "verdict": "killed" if i < killed else "survived"} for i in range(counted)]
        return {"sums": {"all": [killed, counted]} if counted else {}, "mutants": rows}

    def test_ninety_percent_and_all_named_mutants_must_be_killed(self):
        self.assertEqual(mutants.judged(self.report(36, 40), self.report(6, 6))[1], "pass")
        self.assertEqual(mutants.judged(self.report(35, 40), self.report(6, 6))[1], "FAIL")
        self.assertEqual(mutants.judged(self.report(40, 40), self.report(5, 6))[1], "FAIL")
        self.assertEqual(mutants.judged(self.report(0, 0), self.report(0, 0))[1], "FAIL")
        self.assertIn("a.cpp:5", mutants.judged(self.report(40, 40), self.report(5, 6))[0])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
