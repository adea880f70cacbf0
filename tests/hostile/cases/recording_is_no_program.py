#!/usr/bin/env python3
# row: A1
# input: a recording whose config starts programs that it names: its own, on the disk, by a setting or by a script
# right: no program starts unless the command line of today names the database
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "../reports/lib"))
import mcap  # noqa: E402
from programs import *  # noqa: E402,F403

DATABASE = (
    "<agentdb><agent_type_external name='t'><exec_line>/usr/bin/touch {}</exec_line></agent_type_external></agentdb>"
)
TEXT = WORLD.replace("control()", "control() spades{ types = \"t\", players = 1 }")
with Folder() as folder:
    mark, database = folder / "ran", folder / "db.xml"
    database.write_text(DATABASE.format(mark))
    host("--config", "world.lua", "--duration", "1", "--record", "a.mcap", cwd=folder)
    records = mcap.records(folder / "a.mcap")
    before = json.loads(mcap.about(records)["arguments"])
    inside = [("file:db.xml", database.read_bytes())]
    ways = {
        f"--set agentDatabase={where}": (before + ["--set", f"agentDatabase={where}"], TEXT)
        for where in ("../files/db.xml", "db.xml", database)
    }
    for where in ("../files/db.xml", "db.xml", database):
        ways[f"a script with {where}"] = (
            before,
            TEXT.replace('types = "t", players = 1', "")
            + f'local s = get("/sys/server/spades")\ns.database = "{where}"\ns:queueAgents("t", 1)\n',
        )
    for what, (arguments, script) in ways.items():
        mcap.write(folder / "b.mcap", mcap.forged(records, arguments, {"world.lua": script}, inside))
        for command in (
            ["sparkhost", "--from", "b.mcap", "--rate", "max", "--duration", "1.5"],
            ["sparkreplay", "b.mcap", "--verify"],
            ["sparkbatch", "--from", "b.mcap", "--duration", "1.5", "--results", "t.csv"],
        ):
            done = run(*command, cwd=folder)
            judge(f"{what}: {command[0]} starts no program", not mark.exists() and done.returncode >= 0, done.stderr)
            mark.unlink(missing_ok=True)
    done = host("--from", "b.mcap", "--duration", "1.5", cwd=folder)
    judge("going on says what to do", done.returncode == 2 and "--set agentDatabase=" in done.stderr, done.stderr)

    (folder / "starts.lua").write_text(TEXT)
    done = host(
        "--config", "starts.lua", "--duration", "1", "--set", "agentDatabase=db.xml", "--record", "s.mcap", cwd=folder
    )
    judge("the run itself starts its program", mark.exists() and done.returncode == 0, done.stderr)
    mark.unlink(missing_ok=True)
    done = host("--from", "s.mcap", "--at", "0.5", "--duration", "1.5", cwd=folder)
    judge(
        "its recording does not",
        not mark.exists() and done.returncode == 2 and "--set agentDatabase=" in done.stderr,
        done.stderr,
    )
    done = host("--from", "s.mcap", "--at", "0.5", "--duration", "1.5", "--set", "agentDatabase=db.xml", cwd=folder)
    judge("unless the user names the database", mark.exists(), done.stderr)
