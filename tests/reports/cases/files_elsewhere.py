#!/usr/bin/env python3
# row: 21
# input: a recording is verified, exported and gone on from where its folders and files are others, or gone
# right: it plays: what was read is inside and wins; missing folders are a note
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import *  # noqa: E402,F403

WALL = "(RSG 0 1) (nd Transform (setName wall) (setLocalPos 0.6 0 2.6) (nd BoxCollider (setBoxLengths {0} {0} {0})))"
LUA = WORLD + """
arm = nil
new("Space", "/usr/scene/walls")
get("/usr/scene/walls"):importScene("parts/wall.rsg")
include "more.lua"
"""
with Folder() as folder:
    home = folder / "home"
    (home / "models/parts").mkdir(parents=True)
    (home / "models/parts/wall.rsg").write_text(WALL.format(0.3))
    (home / "world.lua").write_text(LUA)
    (home / "more.lua").write_text("x = 1")
    done = host("--config", "world.lua", "--scene-path", "models", "--duration", "11", "--record", "r.mcap", cwd=home)
    judge("it is recorded with a relative folder", done.returncode == 0, done.stderr)
    result = json.loads(done.stdout.splitlines()[-1])["stateHash"] if done.returncode == 0 else ""

    def plays(where, cwd):
        code, line, log = verify(home / "r.mcap", cwd=cwd)
        judge(f"{where}: it verifies", code == 0 and line.get("cycles") == 550, f"{line} {log}")
        table = run(
            "sparkreplay",
            home / "r.mcap",
            "--export",
            folder / "t.csv",
            "--property",
            "/usr/scene/arm.localPos",
            cwd=cwd,
        )
        judge(f"{where}: it is exported", table.returncode == 0, table.stderr)
        (folder / "t.csv").unlink(missing_ok=True)
        on = host("--from", home / "r.mcap", "--at", "10.5", cwd=cwd)
        end = json.loads(on.stdout.splitlines()[-1])["stateHash"] if on.returncode == 0 and on.stdout else on.stderr
        judge(f"{where}: a run goes on from it, to the same end", end == result, end)
        return log

    log = plays("where it was made", home)
    judge("there nothing is said", "models" not in log, log)
    plays("in another folder", folder)
    (home / "models/parts/wall.rsg").write_text(WALL.format(3))
    (home / "more.lua").write_text("error('another text')")
    plays("with other files", home)
    (home / "models").rename(folder / "gone")
    (home / "world.lua").unlink()
    log = plays("without its folders", home)
    judge("that a folder is missing is a note", "models is not there" in log, log)
    done = host("--from", home / "r.mcap", "--scene-path", folder / "gone", "--duration", "12", cwd=home)
    judge("another folder may be named", done.returncode == 0, done.stderr)
