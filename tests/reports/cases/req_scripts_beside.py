#!/usr/bin/env python3
# row: pF13
# input: scene files attach scripts beside them, above them, from the root, of the config; and some that are elsewhere
# right: the nearest one runs, with its arguments, also of a ScriptPerceptor; names that lead out are errors, and what
#    is there does not run; a recording plays without the folder
import shutil
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import *  # noqa: E402,F403

SAYS = 'local args = ... print("%s at " .. self.name .. " with " .. tostring(args))'
CONFIG = """
include "house.lua"
files() scene() physics() simulation() plugin "parser-sexp" plugin "gamecontrol"
new("GameControl", "/sys/server/gamecontrol")
local scene = get("/usr/scene")
scene:importScene("rsg/agent/good.rsg")
for _, name in ipairs{ "above", "absolute", "perceptor", "missing" } do
  local good, why = pcall(function() scene:importScene("rsg/agent/" .. name .. ".rsg") end)
  print("out " .. name .. " " .. tostring(good) .. " " .. tostring(why))
end
"""
with Folder() as folder:
    agent, parts = folder / "scenes/rsg/agent", folder / "scenes/rsg/parts"
    agent.mkdir(parents=True)
    parts.mkdir()
    for where, name in ((agent, "both"), (folder / "scenes", "both"), (parts, "up"), (parts, "root"),
                        (folder, "config"), (folder, "outside")):
        (where / f"{name}.lua").write_text(SAYS % f"{where.name} {name}")
    calls = ("(attachScript both.lua 1)", "(attachScript ../parts/up.lua 2)", "(attachScript rsg/parts/root.lua 3)",
             "(attachScript config.lua 4)")
    nodes = "".join(f"(nd Transform (setName n{i}) {call})" for i, call in enumerate(calls, 1))
    scenes = {
        "good": nodes + "(nd ScriptPerceptor (setName n5) (script both.lua 5))",
        "above": "(nd Transform (attachScript ../../../outside.lua))",
        "absolute": f"(nd Transform (attachScript {folder}/outside.lua))",
        "perceptor": "(nd ScriptPerceptor (script ../../../outside.lua))",
        "missing": "(nd Transform (attachScript nowhere.lua))",
    }
    for name, text in scenes.items():
        (agent / f"{name}.rsg").write_text(f"(RSG 0 1)({text})")
    (folder / "scripts.lua").write_text(CONFIG)
    done = run("sparkhost", "--config", folder / "scripts.lua", "--scene-path", folder / "scenes", "--rate", "max",
               "--duration", "0.1", "--record", folder / "run.mcap")
    log = done.stderr
    judge("it runs", done.returncode == 0, log)
    for what in ("agent both at n1 with 1", "parts up at n2 with 2", "parts root at n3 with 3", "config at n4 with 4",
                 "agent both at n5 with 5"):
        judge(what, what in log, log)
    for name in ("above", "absolute", "perceptor"):
        judge(f"{name}: refused, with the place", f"out {name} false" in log and f"{name}.rsg:1" in log
              and "expected a script beside this file or below the folders of scenes" in log, log)
    judge("one that is missing is an error", "out missing false" in log and "nowhere.lua" in log, log)
    judge("nothing from outside has run", " outside at " not in log, log)
    shutil.rmtree(folder / "scenes")
    again = run("sparkreplay", "--verify", folder / "run.mcap")
    judge("its recording plays without them", again.returncode == 0, again.stdout + again.stderr)
