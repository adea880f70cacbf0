#!/usr/bin/env python3
"""Runs every fenced example of every README. usage: examples.py BUILD [README...]; see examples()

    lua           a config, with what CONTEXT says beside it: runs for some cycles, without errors and faults
    lisp          a scene file, or a part of one: is imported
    json, xml     is read; an agent database is that of the README's configs
    python        runs beside the host that CONTEXT names
    sh            its programs exist and have the options that it uses; pages that are followed are not looked at again
    cpp           is compiled, with the lines of CONTEXT before and after it

An example that needs something around it has an entry in CONTEXT: its README and the number of the example of its kind.
"""
import json
import os
import re
import shlex
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree
import zlib
from pathlib import Path

import follow

ROOT = follow.SOURCES
FOLLOWED = {"README.md"}  # tests/pages/CMakeLists.txt
SECONDS = 300             # for a program that hangs

WORLD = 'include "house.lua" files() scene() physics() simulation() agents{} plugin "sensors" plugin "effectors"\n'
AGENTS = 'plugin "scene" plugin "gamecontrol" new("GameControl", "/sys/server/gamecontrol")\n'
MONITOR = 'plugin "monitor" new("MonitorServer", "/sys/server/monitor")\n'
RUN = 'if not get("/sys/server/simulation") then plugin "simulation" new("Simulation", "/sys/server/simulation") end\n'
KEEPER = """on("start", function(self) self.actions = "(scene rsg/agent/buggy/buggy.rsg)" end)
on("think", function(self, event) self.actions = "(drive 10 0 0)" end)
"""
ASKER = """new("ScriptAspect", "/sys/server/gamecontrol/maker"):on("agentConnected", function(self, event)
  get(event.data):new("TimePerceptor", "time")
end)
new("ScriptBehavior", "/usr/agent/asker"):on("think", function(self, event)
  self.actions = event.cycle == 8 and "(request (perceptor GPS) (name gps))" or ""
end)
"""
BALL = 'local ball = new("Transform", "/usr/scene/Ball") ball:new("RigidBody", "body"):setSphere(500, 0.04)\n'
# An agent of the middleware SPADES: says that it is ready, creates its robot, and answers each sensation.
SPADES_AGENT = """#!/usr/bin/env python3
import os, struct
def read(n):
    data = b""
    while len(data) < n:
        more = os.read(3, n - len(data))
        if not more:
            raise SystemExit
        data += more
    return data
def send(text):
    os.write(4, struct.pack(">I", len(text)) + text)
while True:
    message = read(struct.unpack(">I", read(4))[0])
    if message[:1] == b"D":
        send(b"I")
    elif message[:1] == b"S":
        send(b"A(create)")
        send(b"D")
    else:
        send(b"D")
"""


class Context:
    """What is around an example."""

    def __init__(self, before="", after="", files=None, arguments=(), host=None, replace=None):
        self.before, self.after, self.files, self.arguments = before, after, files or {}, list(arguments)
        self.host = host        # arguments of a host that runs meanwhile, or the text of its config
        self.replace = replace or {}  # texts of the example that mean something of the reader's own


FACES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]  # of a tetrahedron
CORNERS = ["vertex 0 0 0\n", "vertex 1 0 0\n", "vertex 0 1 0\n", "vertex 0 0 1\n"]
STL = "solid s\n" + "".join("facet normal 0 0 1\nouter loop\n" + "".join(CORNERS[i] for i in f) + "endloop\nendfacet\n" for f in FACES) + "endsolid s\n"
OBJ = "v 0 0 0\nv 0.4 0 0\nv 0 0.4 0\nv 0 0 0.4\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"


def port(name):
    at = f"/sys/server/net/{name}"
    return (f'plugin "net-tcp" new("NetServer", "/sys/server/net") new("TcpPort", "{at}") new("LengthPrefixFraming", "{at}/framing")\n'
            f'get("{at}").consumer = "/sys/server/gamecontrol"\n')


def png(size):
    """A picture that is brighter from left to right."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes(255 * x // size for x in range(size)) for _ in range(size))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 0, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


SERVED = ["--config", "soccer-sphere.lua", "--set", "remoteAddress=127.0.0.1:3400", "--set",
          "remoteToken=0123456789abcdef", "--web-port", "0"]
CONTEXT = {
    "README.md lua 1": Context(WORLD + 'delete "/sys/server/physics/engine"\n'),
    "lua/README.md lua 2": Context(WORLD),
    "lua/README.md lua 3": Context(WORLD + BALL + 'local behavior = new("ScriptBehavior", "/usr/agent/b")\n',
                                   files={"rule.lua": "assert(select(1, ...).limit == 3)", "keeper.lua": KEEPER}),
    "lua/README.md lua 4": Context(WORLD + BALL + 'get("/usr/scene"):attachScript("example.lua", { limit = 3, ball = ball })\n',
                                   files={"example.lua": "THIS"}, replace={"then ... end": "then print(1) end"}),
    "plugins/drawing/README.md lua 1": Context(),
    "plugins/files-zip/README.md lua 1": Context(files={"robots.zip": None}),
    "plugins/gamecontrol/README.md lua 2": Context(WORLD),
    "plugins/gamecontrol/README.md lua 3": Context(WORLD, files={"keeper.lua": KEEPER}),
    "plugins/gamecontrol/README.md lua 4": Context(WORLD + BALL + 'local robot, body = ball:new("AgentAspect", "agent"), ball:find("body")\n'
                                                   'robot:new("ScriptBehavior", "mind"):on("think", function(self) self.actions = "(push 3)" end)\n',
                                                   replace={"event) ... end)": "event) end)"}),
    "plugins/gamecontrol/README.md lua 5": Context(WORLD + BALL, files={"ball.lua": KEEPER}),
    "plugins/gamecontrol/README.md lua 6": Context(WORLD + 'local b = new("ScriptBehavior", "/usr/agent/keeper") b:script("keeper.lua")\n', files={"keeper.lua": KEEPER}),
    "plugins/gamecontrol/README.md lua 7": Context(WORLD),
    "plugins/gamecontrol/README.md lua 8": Context(WORLD, ASKER),
    "plugins/monitor-sexp/README.md lua 1": Context(MONITOR),
    "plugins/monitor-web/README.md lua 1": Context(MONITOR, 'server.port = 0\n'),
    "plugins/monitor/README.md lua 2": Context(MONITOR, files={"rule.lua": "assert(self.name == 'board')"}),
    "plugins/net-tcp/README.md lua 1": Context(AGENTS),
    "plugins/parser-json/README.md lua 1": Context(AGENTS + port("json")),
    "plugins/parser-sexp/README.md lua 1": Context(AGENTS + port("agents")),
    "plugins/physics/README.md lua 2": Context(WORLD + 'new("PlaneCollider", "/usr/scene/ground")\n'),
    "plugins/physics/README.md lua 3": Context('include "house.lua" scene() physics() simulation()\n', replace={"/home/me/scenes": "."},
                                               files={"models/stairs.stl": STL, "models/seat.obj": OBJ, "models/hills.png": png(17)}),
    "plugins/remote/README.md lua 1": Context(arguments=["--set", "remoteAddress=127.0.0.1:3401"]),
    "plugins/remote/README.md lua 2": Context('include "house.lua" simulation()\n', host=SERVED),
    "plugins/remote/README.md lua 3": Context('include "house.lua" files() scene() physics() simulation()\n'
                                              'new("Transform", "/usr/scene/room")\n', host=SERVED),
    "plugins/scene-meshes/README.md lua 1": Context(files={"models/chair.obj": OBJ}, arguments=["--scene-path", "."]),
    "plugins/scene-rsg/README.md lua 2": Context(WORLD),
    "plugins/scene-rsg/README.md lisp 1": Context(arguments=[0.1]),
    "plugins/simulation-spades/README.md lua 1": Context(files={"agentdb.xml": "XML", "myagent": SPADES_AGENT}, arguments=["--set", "agentDatabase=agentdb.xml"]),
    "plugins/soccer/README.md lua 2": Context('include "house.lua" include "materials.lua" include "soccer-house.lua" files() scene() materials() physics() simulation() agents{} monitors{}\n'
                                              'soccerVariables{}\n'),
    "tools/sparkbatch/README.md lua 1": Context("function somebodyFell() return true end\n"),
    "plugins/camera/README.md python 1": Context(host=["--config", "camera.lua", "--web-port", "0"]),
    "tests/scenarios/README.md cpp 1": Context('#include "match.h"\nusing namespace spark; using namespace spark::test;\n'),
}


def readmes():
    found = subprocess.run(["git", "ls-files", "*README.md"], cwd=ROOT, capture_output=True, text=True)
    files = [ROOT / f for f in found.stdout.split()] if found.returncode == 0 else []
    return files or [f for f in sorted(ROOT.rglob("README.md")) if "build" not in f.relative_to(ROOT).parts]


def examples(files):
    """(key, line, kind, name, text) of each example."""
    for file in files:
        readme, counts = str(file.relative_to(ROOT)), {}
        for line, kind, name, text in follow.blocks(file):
            counts[kind] = counts.get(kind, 0) + 1
            yield f"{readme} {kind} {counts[kind]}", line, kind, name, text


class Wrong(Exception):
    pass


class Runner:
    def __init__(self, build, all_texts):
        self.bin, self.texts, self.help = Path(build).resolve() / "bin", all_texts, {}

    def host(self, folder, *arguments):
        try:
            done = subprocess.run([self.bin / "sparkhost", "--rate", "max", *arguments], cwd=folder, capture_output=True, text=True, errors="replace", timeout=SECONDS)
        except subprocess.TimeoutExpired:
            raise Wrong(f"it took longer than {SECONDS} s") from None
        errors = [line for line in done.stderr.splitlines() if re.match(r"\S+ error ", line)]
        if done.returncode or errors or '"faults":0' not in done.stdout:
            raise Wrong(f"exit code {done.returncode}, {done.stdout.strip()[-200:]}\n{done.stderr[-2000:]}")

    def write(self, folder, context, key, text):
        for name, content in context.files.items():
            file = folder / name
            file.parent.mkdir(parents=True, exist_ok=True)
            if content == "THIS":
                file.write_text(text)
            elif content == "XML":
                file.write_text(self.texts[key.replace(" lua ", " xml ")])
            elif isinstance(content, bytes):
                file.write_bytes(content)
            elif content is None:
                subprocess.run([sys.executable, "-m", "zipfile", "-c", file, ROOT / "README.md"], check=True)
            else:
                file.write_text(content)
                file.chmod(0o755)

    def lua(self, key, text, context, folder):
        for old, new in context.replace.items():
            text = text.replace(old, new)
        self.write(folder, context, key, text)
        attached = "THIS" in context.files.values()
        (folder / "config.lua").write_text(context.before + ("" if attached else text) + "\n" + context.after + RUN)
        self.host(folder, "--config", "config.lua", "--duration", "0.3", *context.arguments)

    def lisp(self, key, text, context, folder):
        whole = text.startswith("(RSG")
        (folder / "rsg").mkdir()
        (folder / "rsg/example.rsg").write_text(text if whole else f"(RSG 0 1)((nd Transform (nd HingeJoint\n{text}\n)))")
        arguments = "".join(f", {a}" for a in context.arguments)
        (folder / "config.lua").write_text(WORLD + f'plugin "modifiers"\nget("/usr/scene"):importScene("rsg/example.rsg"{arguments})\n')
        self.host(folder, "--config", "config.lua", "--scene-path", folder, "--duration", "0.1")

    def json(self, key, text, context, folder):
        json.loads(text)

    def xml(self, key, text, context, folder):
        xml.etree.ElementTree.fromstring(text)

    def python(self, key, text, context, folder):
        (folder / "example.py").write_text(text)
        done = subprocess.run([sys.executable, "example.py"], cwd=folder, capture_output=True, text=True, timeout=SECONDS)
        if done.returncode:
            raise Wrong(done.stderr)

    def sh(self, key, text, context, folder):
        """The names of programs and of their options. Nothing is run."""
        for command in re.sub(r"\\\n", " ", text).splitlines():
            words = shlex.split(command, comments=True)
            while words and (words[0] == "..." or re.fullmatch(r"\w+=.*", words[0])):
                words = words[1:]
            starts = [0] + [i + 1 for i, w in enumerate(words) if w in ("&", "&&", "|")]
            for i in starts:
                self.command(words[i:])

    def command(self, words):
        if not words:
            return
        words = words[:next((i for i, w in enumerate(words) if w in ("&", "&&", "|")), len(words))]
        program = Path(words[0].removeprefix("build/release/")).name if words else ""
        if words[0].startswith(("tools/", "tests/")) and not (ROOT / words[0]).exists():
            raise Wrong(f"there is no {words[0]}")
        if words[0] == "node" and not (ROOT / words[1]).exists():
            raise Wrong(f"there is no {words[1]}")
        if not (self.bin / program).exists():
            return
        if program not in self.help:
            calls = [[], *[[sub] for sub in ("load", "call", "watch")]] if program == "sparkctl" else [[]]
            said = [subprocess.run([self.bin / program, *call, "--help"], capture_output=True, text=True) for call in calls]
            self.help[program] = "".join(s.stdout + s.stderr for s in said)
        for word in words[1:]:
            option = word.partition("=")[0]
            if option.startswith("--") and not re.search(re.escape(option) + r"\b", self.help[program]) and not re.fullmatch(r"--\w+-port", option):
                raise Wrong(f"{program} has no option {option}")

    def run(self, example):
        """What is wrong with an example; "" if nothing is."""
        key, line, kind, name, text = example
        context = CONTEXT.get(key, Context())
        judge = getattr(self, kind, None)
        if judge is None or name.startswith(follow.SKIP) or (kind == "sh" and key.split()[0] in FOLLOWED):
            return ""
        with tempfile.TemporaryDirectory(prefix="spark-example-") as folder:
            folder, beside = Path(folder), None
            try:
                if context.host:
                    beside = subprocess.Popen([self.bin / "sparkhost", *context.host], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
                    beside.stdout.readline()
                judge(key, text, context, folder)
            except (Wrong, ValueError, OSError, subprocess.SubprocessError) as wrong:
                return f"{key.split()[0]}:{line}: {wrong}"
            finally:
                if beside:
                    beside.terminate()
                    beside.communicate()
        return ""


def main(arguments):
    follow.own_network()
    if os.environ.get("SPARK_OWN_NETWORK"):
        follow.raise_loopback()
    chosen = [Path(a).resolve() for a in arguments[1:]] or readmes()
    found = list(examples(chosen))
    unknown = set(CONTEXT) - {e[0] for e in examples(readmes())}
    runner = Runner(arguments[0], {e[0]: e[4] for e in found})
    # One after the other: they take the usual ports.
    wrong = [w for w in map(runner.run, found) if w] + [f"there is no example {key}" for key in sorted(unknown)]
    for text in wrong:
        print(text, file=sys.stderr)
    print(f"{len(found)} examples, {len(wrong)} wrong")
    return 1 if wrong or not found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
