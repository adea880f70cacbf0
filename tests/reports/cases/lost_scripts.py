#!/usr/bin/env python3
# row: pF3
# input: sparkctl attach, run and make get what is no script: a folder, devices, other bytes, nothing, too much; scripts
#   with several results
# right: one sentence with file and line, exit code 1, and the host goes on; all results, one a line
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import *  # noqa: E402,F403

FILES = {
    "latin.lua": b"-- gr\xfc\xdfe\nreturn 5\n",
    "late.lua": b"local a = 1\nlocal b = '\xff'\n",
    "empty.lua": b"",
    "long.lua": b"-- x\n" * 7000,
    "wrong.lua": b"local a = 1\n\nlocal = 3\n",
    "fails.lua": b"local a\n\nreturn a.b\n",
    "code.lua": b"\x1bLua" + bytes(60),
    "function.lua": b"return 1, print\n",
    "bom.lua": b"\xef\xbb\xbfreturn 'with a mark'\n",
    "none.lua": b"return\n",
    "three.lua": b"return 1, nil, 'a b', { 2, 3 }, self\n",
}

with Folder() as folder:
    for name, data in FILES.items():
        (folder / name).write_bytes(data)
    host = Live("--config", folder / "world.lua", cwd=folder)

    def tried(what, words, why, code=1):
        done = host.ctl(*words)
        said = done.stdout if code == 0 else done.stderr
        sentence = said.split("\n  from ")[0].removesuffix("\n")
        one_line = code == 0 or (done.stdout == "" and said.startswith("sparkctl: ") and "\n" not in sentence)
        good = said.removesuffix("\n") == why if code == 0 else why in said
        judge(f"{what}: {said.strip()[:100]!r}", done.returncode == code and good and one_line, done)

    def attached(name, why, code=1):
        tried(f"attach {name}", ["attach", "/usr/scene", folder / name if "/" not in name else name], why, code)

    attached("latin.lua", "latin.lua:1: expected UTF-8")
    attached("late.lua", "late.lua:2: expected UTF-8")
    attached("empty.lua", "empty.lua is empty")
    attached("long.lua", "at most 30000 bytes")
    attached("wrong.lua", "wrong.lua:3: ")
    attached("fails.lua", "fails.lua:3: ")
    attached("code.lua", "code.lua")
    attached("function.lua", "function.lua: what it returned: ")
    attached("missing.lua", "No such file")
    attached("/usr/", "is a folder")
    attached("/dev/null", "is empty")
    attached("/dev/zero", "at most 30000 bytes")
    attached("bom.lua", "with a mark", 0)
    attached("none.lua", "", 0)
    attached("three.lua", "1\nnil\na b\n{2, 3}\n/usr/scene", 0)
    tried("run with two results", ["run", "return 7, { 'a', { 1 } }"], '7\n{"a", {1}}', 0)
    tried("run with nil", ["run", "return nil"], "", 0)
    tried("run of nothing", ["run", ""], "is empty")
    tried("run of other bytes", ["run", b"return '\xe4'"], "expected UTF-8")
    tried("run at other bytes", ["run", "return 1", "--at", b"/usr/\xe4"], "UTF-8")
    tried("make of other bytes", ["make", b"Tr\xe4nsform", "/usr/a"], "UTF-8")
    tried("make at other bytes", ["make", "Transform", b"/usr/\xe4"], "UTF-8")
    tried("set of other bytes", ["set", "/usr/scene.name", b"\xe4"], "UTF-8")
    tried("make of a class that is unknown", ["make", "Transfrom", "/usr/a"], "Transform")
    tried("the host goes on", ["run", "return 1 + 1"], "2", 0)
    code, log = host.stop()
    judge("it ends well", code == 0, log)
