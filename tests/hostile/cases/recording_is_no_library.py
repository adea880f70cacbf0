#!/usr/bin/env python3
# row: A1
# input: a recording whose command line names folders with a library: in the recording, beside it, on the disk
# right: verifying, exporting and going on load none of them
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "../reports/lib"))
import mcap  # noqa: E402
from programs import *  # noqa: E402,F403

import shutil

SOURCE = '#include <stdio.h>\n__attribute__((constructor)) static void run(void) { fclose(fopen("%s", "w")); }\n'
with Folder() as folder:
    mark = folder / "ran"
    evil = folder / "disk" / "evil.so"
    evil.parent.mkdir()
    (folder / "evil.c").write_text(SOURCE % mark)
    compiled = subprocess.run(["cc", "-shared", "-fPIC", "-o", evil, folder / "evil.c"], capture_output=True, text=True)
    judge("the library is made", compiled.returncode == 0, compiled.stderr)
    host("--config", "world.lua", "--duration", "1", "--record", "a.mcap", cwd=folder)
    records = mcap.records(folder / "a.mcap")
    before = json.loads(mcap.about(records)["arguments"])
    for where in ("../files", "../scenes", "files", "disk", folder / "disk", "."):
        shutil.copy(evil, folder / "evil.so")
        mcap.write(
            folder / "b.mcap",
            mcap.forged(
                records, before + ["--plugin-path", str(where)], attachments=[("file:evil.so", evil.read_bytes())]
            ),
        )
        for command in (
            ["sparkreplay", "b.mcap", "--verify"],
            ["sparkreplay", "b.mcap", "--export", "t.csv", "--property", "/usr/scene/arm.localPos"],
            ["sparkhost", "--from", "b.mcap", "--rate", "max", "--duration", "1.5"],
        ):
            done = run(*command, cwd=folder)
            judge(
                f"--plugin-path {where}: {command[0]} {command[2]} loads none",
                not mark.exists() and done.returncode in (0, 2),
                done.stderr,
            )
            judge("and says so", "--plugin-path" in done.stderr, done.stderr)
            mark.unlink(missing_ok=True)
            (folder / "t.csv").unlink(missing_ok=True)
    done = run("sparkreplay", "b.mcap", "--verify", "--plugin-path", "disk", cwd=folder)
    judge("the user's own --plugin-path is searched", mark.exists() and done.returncode == 0, done.stderr)
