"""tools/mutate: its operators, draws and counts, the tests that it finds, and that it restores the files and goes on where it stopped."""
import importlib.machinery
import importlib.util
import json
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "tools"))
loader = importlib.machinery.SourceFileLoader("mutate", str(ROOT / "tools/mutate"))
spec = importlib.util.spec_from_loader("mutate", loader)
mutate = importlib.util.module_from_spec(spec)
sys.modules["mutate"] = mutate
loader.exec_module(mutate)
from acceptance import mutants  # noqa: E402
from mutation import bench, operators, product, suite  # noqa: E402


class OfCompiler(unittest.TestCase):
    def changed(self, line, *expected, language=operators.CPP):
        self.assertEqual(sorted(after for _, after in operators.of_compiler(line, language)), sorted(expected))

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
        for line in ("  // a < b", "#include <x>", '  auto t("a < b && 1");', "  static_assert(a == 1);", "  prefetch(x + 1);", ""):
            self.changed(line)
        self.changed('  x = f("1 < 2", a < b);  // 1 + 1', '  x = f("1 < 2", a <= b);  // 1 + 1')

    def test_template_brackets_and_bounds_of_loops_are_unchanged(self):
        self.changed("  std::vector<int> x;")
        self.changed("  for (std::size_t i = begin; i < end; ++i)")

    def test_lua_and_typescript_have_their_own_words(self):
        self.changed("if a == b and c then", "if a ~= b and c then", "if a == b or c then", "if not (a == b and c) then", language=operators.LUA)
        self.changed("  physics(engine)  -- 1 + 1", "  ", language=operators.LUA)
        self.changed("  x = [[ 1 + 1 ]]", language=operators.LUA)
        self.changed("    if (a === b) c.push(1);", "    if (a !== b) c.push(1);", "    if (!(a === b)) c.push(1);", "    if (a === b) c.push(2);",
                     language=operators.TYPESCRIPT)
        self.changed("  private lost(): void {", "  private lost(): void { return;", language=operators.TYPESCRIPT)


class OfReviewer(unittest.TestCase):
    """What a reviewer would change, each by its name."""

    def changed(self, text, *expected, file="core/kernel/src/a.cpp"):
        found = [(m.operator, operators.apply(m, text)) for _, some in operators.mutants_of(file, text) for m in some if m.operator in operators.REVIEWER]
        for operator, after in expected:
            self.assertIn((operator, after), found)
        return found

    def test_a_check_of_input_is_removed_with_what_it_throws(self):
        self.changed("  if (x > kMost)\n    throw Error(\n        \"too many\");\n  go();", (operators.CHECK, "  ;\n\n\n  go();"))
        self.changed("  if (!word) return \"expected a word\";", (operators.CHECK, "  ;"))
        self.changed("  expectAxis(axis);", (operators.CHECK, "  ;"))
        self.changed("if x < 1 then error(\"expected more\") end", (operators.CHECK, ""), file="lua/a.lua")

    def test_a_field_is_left_out_of_the_state(self):
        text = "  void fields(F& f) {\n    f(a_, b_);\n  }\n  f(c_, d_);"
        found = self.changed(text, (operators.STATE, text.replace("a_, ", "")), (operators.STATE, text.replace(", b_", "")))
        self.assertFalse([after for operator, after in found if operator == operators.STATE and "c_, d_" not in after], "it is not in a function of the state")
        self.changed("  d.property(\"a\", &A::a_).state().doc(\"A.\");", (operators.STATE, "  d.property(\"a\", &A::a_).doc(\"A.\");"))

    def test_a_log_line_is_swallowed(self):
        self.changed("  kernel().log().warning(\n      \"{}\", path());", (operators.LOG, "  ;\n"))
        self.changed("  if (!known) log().info(\"unknown\");", (operators.LOG, "  ;"))

    def test_the_order_is_another(self):
        self.changed("for (const auto& x : all(a)) out.push_back(f(x));",
                     (operators.ORDER, "#include <ranges>\n#line 1\nfor (const auto& x : std::views::reverse(all(a))) out.push_back(f(x));"))
        self.changed("for (int i = 0; i < n; ++i) send(i);", (operators.ORDER, "for (int i = n; i-- > 0;) send(i);"))
        self.changed("for (const x of all) this.add(x);", (operators.ORDER, "for (const x of [...all].reverse()) this.add(x);"), file="plugins/monitor-web/viewer/src/a.ts")

    def test_it_happens_one_cycle_late(self):
        self.changed("  while (due_ <= now) {", (operators.LATE, "  while (due_ < now) {"))
        self.changed("void Drive::step() {\n}", (operators.LATE, "void Drive::step() { static bool begun = false; if (!begun) { begun = true; return; }\n}"))

    def test_the_frame_and_the_unit_are_wrong(self):
        self.changed("  return pose.rotation.transpose() * v;", (operators.FRAME, "  return pose.rotation * v;"))
        self.changed("  return a.worldPosition();", (operators.FRAME, "  return a.localPosition();"))
        self.changed("  const double a = degToRad(b);", (operators.UNIT, "  const double a = (b);"))
        self.changed("  x = y * kDegrees;", (operators.UNIT, "  x = y;"))

    def test_a_limit_is_off_by_one(self):
        self.changed("  if (clients < kMostClients) return;", (operators.LIMIT, "  if (clients <= kMostClients) return;"))

    def test_a_right_is_not_asked_for(self):
        self.changed("bool GameControl::mayLoad(const A& a) {\n}", (operators.RIGHT, "bool GameControl::mayLoad(const A& a) { return true;\n}"))
        self.changed("  if (!viewer.referee) throw Error(\"no\");", (operators.RIGHT, "  ;"))

    def test_a_resource_is_not_released(self):
        self.changed("  socket_.close();", (operators.RESOURCE, "  ;"))

    def test_every_operator_of_a_reviewer_is_in_the_product(self):
        found = set()
        for file in ("plugins/gamecontrol/game_control.cpp", "plugins/humanoid-team/humanoid/walk.h", "plugins/humanoid-team/humanoid/percepts.cpp",
                     "plugins/remote/remote_server.cpp", "plugins/physics/joint.cpp", "plugins/physics/rigid_body.cpp", "core/base/src/output_file.cpp"):
            found |= {m.operator for _, some in operators.mutants_of(file, (ROOT / file).read_text()) for m in some}
        self.assertEqual(set(operators.REVIEWER) - found, set())


class Draw(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        (self.root / "core/kernel/src").mkdir(parents=True)
        self.file = "core/kernel/src/a.cpp"
        self.write("".join(f"  x{i} = y + {i};\n" for i in range(20)) + "".join(f"  socket{i}.close();\n" for i in range(9)) + "  expect(x);\n")

    def write(self, text):
        (self.root / self.file).write_text(text)

    def draw(self, seed="1"):
        return product.drawn([self.file], seed, self.root)

    def test_the_draw_depends_on_the_seed(self):
        self.assertEqual(self.draw(), self.draw())
        self.assertNotEqual(self.draw("1"), self.draw("2"))
        self.assertEqual(len(self.draw()), 30)  # one per line

    def test_reviewers_and_compilers_take_turns_and_so_do_a_reviewers_operators(self):
        names = [m.operator in operators.REVIEWER for m in self.draw()]
        self.assertEqual(names[:6], [True, False] * 3)
        self.assertIn(operators.CHECK, [m.operator for m in self.draw()[:4]])

    def test_a_change_elsewhere_does_not_change_the_draw(self):
        before = [(m.before, m.after) for m in self.draw()]
        self.write("#include <z>\n\n" + (self.root / self.file).read_text())
        self.assertEqual([(m.before, m.after) for m in self.draw()], before)

    def test_each_folder_has_its_share(self):
        self.assertEqual(product.shares({"a": 100, "b": 10, "c": 2}, 11), {"a": 6, "b": 3, "c": 2})
        self.assertEqual(sum(product.shares({"a": 500, "b": 100, "c": 90}, 40).values()), 40)

    def test_the_whole_product_is_drawn_from(self):
        files = product.sources([])
        folders = product.folders(files)
        expected = {"core/base", "core/kernel", "core/message", "core/script", "lua", product.VIEWER, product.TOGETHER, "tools/sparkhost"}
        self.assertEqual(expected - set(folders), set())
        plugins = {p.parent.name for p in (ROOT / "plugins").glob("*/CMakeLists.txt")}
        self.assertEqual(plugins - {f.split("/")[1] for f in files if f.startswith("plugins/")}, set())
        self.assertFalse([f for f in files if "/tests/" in f or f.startswith("plugins/api/")])


class Judge(unittest.TestCase):
    """The bench with fake builds and tests."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tree = Path(folder.name)
        (self.tree / "core/kernel/src").mkdir(parents=True)
        self.file = self.tree / "core/kernel/src/a.cpp"
        self.file.write_text("one < 1;\nok();\nlast();\n")
        self.bench = bench.Bench(tree=self.tree)
        self.bench.build_folder.mkdir(parents=True)
        self.bench.suite = self
        self.near = [self.a_test(name, seconds) for name, seconds in (("quick", 1.0), ("slow", 2.0))]
        self.far = [self.a_test("remote", 3.0)]
        self.asked = []
        self.bench.build = lambda targets, output=None, mutant=False: "broken" not in self.file.read_text()
        self.addCleanup(setattr, bench, "LEAST_TIMEOUT", bench.LEAST_TIMEOUT)
        bench.LEAST_TIMEOUT = 3600  # what is quick is never too slow

    def rings(self, file):
        return self.near, self.far

    def targets_of(self, file):
        return {"spark-kernel"}

    def a_test(self, name, seconds):
        self.bench.known[name] = seconds
        return self.program(suite.Test(name, [str(self.tree / name)], "core", program=name, needs=(name,)), "exit 0")

    def program(self, test, text):
        file = Path(test.command[0])
        file.write_text(f"#!/bin/sh\n{text}\n")
        file.chmod(0o755)
        return test

    def judge(self, after):
        before = self.file.read_text()
        verdict = self.bench.judge(operators.Mutant("core/kernel/src/a.cpp", 1, "one < 1;", after))
        self.assertEqual(self.file.read_text(), before)
        return verdict

    def test_a_mutant_that_no_test_notices_survives(self):
        self.assertEqual(self.judge("one <= 1;"), ("survived", None))

    def test_the_fastest_failing_test_kills(self):
        self.program(self.near[0], f"! grep -q '<=' {self.file}")
        self.program(self.near[1], "exit 1")
        self.assertEqual(self.judge("one <= 1;"), ("killed", "quick"))

    def test_a_crash_kills(self):
        self.program(self.near[1], "kill -SEGV $$")
        self.assertEqual(self.judge("one <= 1;"), ("killed", "slow"))

    def test_a_timeout_kills_and_ends_all_child_processes(self):
        self.program(self.near[1], "sleep 1000 & wait")
        bench.LEAST_TIMEOUT = 0.2
        self.bench.known["slow"] = 0.01  # it comes first
        self.assertEqual(self.judge("one <= 1;"), ("killed", "slow"))

    def test_what_the_nearest_do_not_notice_a_far_test_may(self):
        self.program(self.far[0], f"! grep -q '<=' {self.file}")
        self.assertEqual(self.judge("one <= 1;"), ("killed", "remote"))
        self.bench.far = False
        self.assertEqual(self.judge("one <= 1;"), ("survived", None))

    def test_a_test_that_fails_without_a_mutant_kills_none(self):
        del self.bench.known["remote"], self.bench.known["quick"]
        self.program(self.far[0], "exit 1")
        with open("/dev/null", "w") as sys.stderr:
            self.assertEqual(self.judge("one <= 1;"), ("survived", None))
            self.program(self.near[0], "exit 1")
            with self.assertRaises(SystemExit):
                self.judge("one <= 1;")
        sys.stderr = sys.__stderr__
        self.assertEqual(self.bench.known["remote"], "fails")

    def test_a_skipped_test_kills_none(self):
        self.program(self.near[0], "exit 77")
        self.assertEqual(self.judge("one <= 1;"), ("survived", None))

    def judged(self, texts, count, file=None, again=None, lists=(frozenset(), None)):
        drawn = [operators.Mutant("core/kernel/src/a.cpp", 1, "one < 1;", t) for t in texts]
        report = mutate.Report(file, "1", again)
        with open("/dev/null", "w") as sys.stdout:
            mutate.judged(self.bench, drawn, count, "core/kernel", report, *lists)
        sys.stdout = sys.__stdout__
        return report

    def test_a_mutant_that_does_not_compile_or_is_in_a_list_is_replaced_by_another(self):
        same = {("core/kernel/src/a.cpp", "one < 1;", "one <= 1;")}
        report = self.judged(["broken;", "one <= 1;", "one > 1;", "never reached;"], 1, lists=(same, None))
        self.assertEqual([r["verdict"] for r in report.rows.values()], ["broken", "equivalent", "survived"])
        self.assertEqual(mutate.summary(report.rows.values()), {"core/kernel": [0, 1], "all": [0, 1]})
        report = self.judged(["one <= 1;"], 1, lists=(frozenset(), {"core/kernel/src/a.cpp": ["one < 1"]}))
        self.assertEqual(len(report.rows), 0)

    def test_the_same_command_goes_on_where_it_stopped(self):
        file = self.tree / "report.json"
        self.judged(["one <= 1;"], 1, file)
        self.assertEqual(json.loads(file.read_text())["sums"], {"core/kernel": [0, 1], "all": [0, 1]})
        judge, self.bench.judge = self.bench.judge, lambda mutant: self.asked.append(mutant.after) or judge(mutant)
        self.judged(["one <= 1;", "one > 1;"], 2, file)
        self.assertEqual(self.asked, ["one > 1;"])
        self.program(self.near[0], "exit 1")
        report = self.judged(["one <= 1;", "one > 1;"], 2, file, again="another")
        self.assertEqual(mutate.summary(report.rows.values())["all"], [2, 2])
        report = self.judged(["one > 1;"], 1, file)
        report.finish()
        self.assertEqual(json.loads(file.read_text())["sums"]["all"], [1, 1])
        with self.assertRaises(SystemExit):
            mutate.Report(file, "2")

    def test_what_survived_the_nearest_tests_alone_is_judged_again_by_all(self):
        file = self.tree / "report.json"
        self.program(self.far[0], "exit 1")
        self.bench.far = False
        self.assertEqual([r["verdict"] for r in self.judged(["one <= 1;"], 1, file).rows.values()], ["survived"])
        self.bench.far = True
        self.bench.known["remote"] = 1.0
        self.assertEqual([r["verdict"] for r in self.judged(["one <= 1;"], 1, file).rows.values()], ["killed"])


class Tests(unittest.TestCase):
    """What CMake and ctest know of this build."""

    @classmethod
    def setUpClass(cls):
        cls.commands = suite.Suite.read_commands(type("Built", (), {"build": Path(sys.argv[1]).absolute()}))

    def test_ctest_names_the_programs(self):
        self.assertTrue(self.commands["core-tree"][0].endswith("/tests/test-core-tree"))
        self.assertIn("[#zip_test]", self.commands["files-zip"])

    def test_the_table_of_nearest_tests_names_tests(self):
        self.assertEqual({t for tests in suite.NEAREST.values() for t in tests} - set(self.commands), set())
        self.assertEqual([f for f in suite.NEAREST if not (ROOT / f).is_dir()], [])

    def test_what_is_built_from_a_file_can_notice_it(self):
        s = suite.Suite.__new__(suite.Suite)
        s.tree, s.texts = ROOT, {}
        s.targets = {"spark-kernel": (["core/kernel/src/link.cpp"], []), "plugin-a": (["plugins/a/a.cpp"], ["spark-kernel"]), "plugin-b": (["plugins/b/b.cpp"], []),
                     "test-a": ([], ["plugin-a"]), "test-b": ([], ["plugin-b"]), "test-match": ([], ["plugin-a", "plugin-b"])}
        s.tests = {t: suite.Test(t, [], folder, program=program) for t, folder, program in
                   (("a", "plugins/a", "test-a"), ("b", "plugins/b", "test-b"), ("match", "tests/system", "test-match"))}
        rings = lambda file: tuple([t.name for t in ring] for ring in s.rings(file))
        self.assertEqual(rings("plugins/a/a.cpp"), (["a"], ["match"]))
        self.assertEqual(rings("plugins/b/header.h"), (["b"], ["match"]))
        self.assertEqual(rings("core/kernel/src/link.cpp"), ([], ["a", "match"]))


class Lists(unittest.TestCase):
    def test_named_mutants_apply_to_the_tree(self):
        blocks = mutate.read_list(ROOT / "tools/mutate.named")
        self.assertGreaterEqual(len(blocks), 6)
        for file, before, after, why in blocks:
            mutant = mutate.named(file, before, after)
            text = (ROOT / file).read_text()
            self.assertNotEqual(operators.apply(mutant, text), text)
            self.assertTrue(why)

    def test_equivalent_mutants_apply_to_the_tree_and_have_a_reason(self):
        for file, before, after, why in mutate.read_list(ROOT / "tools/mutate.equivalent"):
            found = {mutate.key_of(m) for _, some in operators.mutants_of(file, (ROOT / file).read_text()) for m in some}
            self.assertIn((file, mutate.words(before), mutate.words(after)), found)
            self.assertGreater(len(why), 15)


class Verdict(unittest.TestCase):
    def report(self, killed, counted, folder="a", name="a.cpp"):
        rows = [{"file": name, "line": i, "folder": folder, "operator": "x", "verdict": "killed" if i < killed else "survived"} for i in range(counted)]
        return {"sums": mutate.summary(rows), "mutants": rows}

    def together(self, *reports):
        rows = [row for report in reports for row in report["mutants"]]
        return {"sums": mutate.summary(rows), "mutants": rows}

    def test_ninety_percent_of_all_and_three_quarters_of_each_folder_must_be_killed(self):
        self.assertEqual(mutants.judged(self.report(36, 40), 40)[1], "pass")
        self.assertEqual(mutants.judged(self.report(35, 40), 40)[1], "FAIL")
        self.assertEqual(mutants.judged(self.together(self.report(36, 36), self.report(3, 4, "b")), 40)[1], "pass")
        self.assertEqual(mutants.judged(self.together(self.report(37, 37), self.report(2, 3, "b")), 40)[1], "FAIL")
        self.assertEqual(mutants.judged(self.report(36, 40), 41)[1], "FAIL", "some are not judged")
        self.assertEqual(mutants.judged(self.report(0, 0), 0)[1], "FAIL")
        self.assertIn("a.cpp:37", mutants.judged(self.report(36, 40), 40)[0])

    def test_all_that_once_survived_must_be_killed(self):
        self.assertEqual(mutants.judged_again(self.report(6, 6), 6)[1], "pass")
        self.assertEqual(mutants.judged_again(self.report(5, 6), 6)[1], "FAIL")
        self.assertEqual(mutants.judged_again(self.report(0, 0), 0)[1], "FAIL")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
