"""The tests that can notice a mutant, and in which order they are asked. CMake and ctest know it: ctest which programs are tests, with which
arguments, and in which folder they were declared; CMake's file API which target compiles a file, and what is built for a test."""
import json
import os
import re
import shutil
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

from mutation.product import VIEWER, folder_of

# Tests nearest to a folder, besides those that its CMakeLists.txt declares.
CORE = ["core-text", "core-jobs", "core-plugins", "core-tree", "core-files", "lua"]
NEAREST = {
    "core/base": CORE, "core/message": ["core-text", "parser-sexp", "parser-json"], "core/kernel": [*CORE, "golden"], "core/script": ["lua", "golden"],
    "plugins/net-tcp": ["protocol-transport", "protocol-nagle"],
    "plugins/physics": ["engines", "oracle-joints", "golden"],
    "plugins/physics-ode": ["physics", "oracle-limits", "oracle-contacts", "oracle-joints", "engines", "golden"],
    "plugins/physics-articulated": ["oracle-limits", "oracle-contacts", "oracle-joints", "engines"],
    "plugins/physics-bullet": ["engines"], "plugins/physics-mujoco": ["engines", "models"],
    "plugins/humanoid-team": ["system-humanoid"], "plugins/sphere-team": ["system-match"], "plugins/recorder": ["system-recording", "system-snapshot"],
    "plugins/monitor-sexp": ["monitor-captures"], "plugins/camera": ["camera-client"], "plugins/gamecontrol": ["protocol-agents", "protocol-joining", "protocol-returning", "protocol-waiting"], "plugins/soccer": ["scenario-restarts", "scenario-goals", "scenario-fouls"],
    "tools/sparkctl": ["system-host"], "tools/sparkhost": ["system-host"], "tools/sparkreplay": ["system-recording"], "tools/sparkbatch": ["system-batch"],
    "tools/sparkcomm": ["system-rcssserver3d"], "tools/sparkwatch": ["web-watching"], "tools/spectators": ["monitor-crowd", "web-watching"], "tools/agents": ["system-demos", "system-joining"],
    "lua": ["golden"],
}
FAR_LABELS = ("web",)  # browsers: for the viewer and its server
STORIES = ("browser-small", "browser-look", "browser-live", "browser-inspect")  # the quick ones, for the viewer
NOT_ASKED = re.compile(r"page-.*|tools-.*|bench-.*|viewer-unit|browser-readme")  # of documents, of scripts, of speed; viewer-unit is run by file


@dataclass
class Test:
    name: str
    command: list
    folder: str  # where it is declared, below the root
    environment: dict = field(default_factory=dict)
    labels: list = field(default_factory=list)
    program: str = ""  # target of its program; "" for a script
    needs: tuple = ("programs", "plugins")  # targets that are built for it: a script may start all programs
    sources: list = field(default_factory=list)  # of the test itself, below the root
    cwd: Path = None  # where it runs, instead of in the build


class Suite:
    """All tests of a configured build."""

    def __init__(self, tree, build):
        self.tree, self.build = Path(tree), Path(build)
        self.targets = self.read_targets()
        self.tests = self.read_tests()
        self.texts = {}

    def read_targets(self):
        """{target: (its sources and headers as far as CMake knows them, names of the targets that it is built from)}"""
        reply = self.build / ".cmake/api/v1/reply"
        index = json.loads(max(reply.glob("codemodel-v2-*.json"), key=lambda f: f.stat().st_mtime).read_text())
        out = {}
        for entry in index["configurations"][0]["targets"]:
            target = json.loads((reply / entry["jsonFile"]).read_text())
            out[target["name"]] = ([s["path"] for s in target.get("sources", [])], [d["id"].split("::")[0] for d in target.get("dependencies", [])])
        return out

    def read_tests(self):
        listed = subprocess.run(["ctest", "--test-dir", self.build, "--show-only=json-v1"], stdout=subprocess.PIPE, text=True, check=True).stdout
        commands = self.read_commands()  # ctest conceals those that are not built yet
        out = {}
        for entry in json.loads(listed)["tests"]:
            if NOT_ASKED.fullmatch(entry["name"]):
                continue
            known = {p["name"]: p["value"] for p in entry["properties"]}
            if not (command := entry.get("command") or commands.get(entry["name"])):
                continue
            folder = os.path.relpath(known["WORKING_DIRECTORY"], self.build)
            program = Path(command[0]).name if Path(command[0]).is_relative_to(self.build) else ""
            environment = dict(e.split("=", 1) for e in known.get("ENVIRONMENT", []))
            test = Test(entry["name"], command, folder, environment, known.get("LABELS", []), program, (program,) if program else Test.needs)
            stems = re.findall(r"\[#(\w+)\]", " ".join(command))
            written = self.targets.get(program, ([], []))[0]
            test.sources = [s for s in written if not s.startswith("build/") and (not stems or Path(s).stem in stems)]
            test.sources += [os.path.relpath(c, self.tree) for c in command if c.startswith(str(self.tree)) and not c.startswith(str(self.build)) and Path(c).is_file()]
            out[test.name] = test
        return out

    def read_commands(self):
        """{test: its command}, as CMake has written them for ctest."""
        out = {}
        for file in self.build.glob("*/**/CTestTestfile.cmake"):
            for name, words in re.findall(r"^add_test\(\[=\[(.+?)\]=\] (.*)\)$", file.read_text(), re.M):
                out[name] = [w.replace('\\"', '"').replace("\\\\", "\\") for w in re.findall(r'"((?:\\.|[^"\\])*)"', words)]
        return out

    def needed_by(self, target):
        """Names of all targets that `target` is built from, and itself."""
        seen, todo = set(), [target]
        while todo:
            if (name := todo.pop()) not in seen:
                seen.add(name)
                todo += self.targets.get(name, ([], []))[1]
        return seen

    def targets_of(self, file):
        """Targets that compile the file; for a header, those of its folder."""
        exact = {name for name, (files, _) in self.targets.items() if file in files}
        if exact:
            return exact
        folder = os.path.dirname(file)
        while folder:
            found = {name for name, (files, _) in self.targets.items() if any(os.path.dirname(f) == folder for f in files) and not name.startswith("test-")}
            if found:
                return found
            folder = os.path.dirname(folder)
        return set()

    def text_of(self, test):
        if test.name not in self.texts:
            self.texts[test.name] = "\n".join((self.tree / s).read_text(errors="replace") for s in test.sources if (self.tree / s).is_file())
        return self.texts[test.name]

    def words_of(self, file):
        """What a test says that is about the file: the names of its class or config, and of configs that include that."""
        stem = Path(file).stem
        if not file.endswith(".lua"):
            return {stem, "".join(w.capitalize() for w in stem.split("_"))}
        words, todo = set(), [stem]
        while todo:
            if (name := todo.pop()) not in words:
                words.add(name)
                todo += [f.stem for f in (self.tree / "lua").glob("*.lua") if f'"{name}.lua"' in f.read_text()]
        return {f"{w}.lua" for w in words} | {f'"{w}"' for w in words}

    def viewer_unit(self, file):
        """Those unit tests of the viewer that import the file, after it was type-checked and bundled."""
        folder = self.build / "viewer"
        command = [shutil.which("node") or "nodejs", folder / "node_modules/vitest/vitest.mjs", "related", "--run", "--passWithNoTests",
                   folder / Path(file).relative_to(VIEWER)]
        environment = {"SPARK_SOURCES": str(self.tree), "NODE_OPTIONS": "--require=./tests/helpers/patience.cjs"}
        return Test("viewer-unit", command, VIEWER, environment, needs=("viewer",), cwd=folder)

    def rings(self, file):
        """([nearest tests], [all others that are built from the file]); those that speak of the file come first in the second."""
        folder, touched = folder_of(file), self.targets_of(file)
        if file.startswith(VIEWER + "/"):
            return [self.viewer_unit(file)], [t for t in self.tests.values() if t.name in STORIES]
        words = re.compile("|".join(rf"(?<!\w){re.escape(w)}(?!\w)" for w in self.words_of(file)))
        if file.endswith(".lua"):  # what runs a config may name it, and starts hosts
            reaches = lambda t: bool(words.search(self.text_of(t))) or "unit" not in t.labels
        else:
            reaches = lambda t: not t.program or bool(self.needed_by(t.program) & touched)
        near = [t for t in self.tests.values() if reaches(t) and (
            t.folder == folder or t.folder.startswith(folder + "/") or t.name in NEAREST.get(folder, []) or file.endswith(".lua") and words.search(self.text_of(t)))]
        far = [t for t in self.tests.values() if t not in near and reaches(t) and (folder == "plugins/monitor-web" or not set(t.labels) & set(FAR_LABELS))]
        return near, sorted(far, key=lambda t: not words.search(self.text_of(t)))
