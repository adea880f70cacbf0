#!/usr/bin/env python3
# row: A5
# input: names beside a snapshot, links, inputs, devices
# right: a file that is not named is never changed; inputs and devices stay
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "../reports/lib"))
from programs import *  # noqa: E402,F403

import os
import stat

with Folder() as folder:
    model = folder / "arm.urdf"
    text = ("<robot name='r'><link name='base'><inertial><mass value='1'/>"
            "<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link></robot>")
    model.write_text(text)
    running = Live("--config", "world.lua", "--record", "now.mcap.part", cwd=folder)
    (folder / "victim").write_text("mine")
    (folder / "b.mcap.part").write_text("mine")
    (folder / "c.mcap.part").symlink_to("victim")
    for name in ("b.mcap", "c.mcap", "now.mcap"):
        done = running.ctl("snapshot", folder / name)
        judge(
            f"the snapshot {name} is written",
            done.returncode == 0 and (folder / name).stat().st_size > 100,
            done.stderr,
        )
    judge(
        "files beside it are kept",
        (folder / "victim").read_text() == "mine"
        and (folder / "b.mcap.part").read_text() == "mine"
        and (folder / "c.mcap.part").is_symlink(),
    )
    (folder / "l.mcap").symlink_to("victim")
    done = running.ctl("snapshot", folder / "l.mcap")
    judge(
        "a link to a file is refused", done.returncode == 1 and (folder / "victim").read_text() == "mine", done.stderr
    )
    for name in ("now.mcap.part",):
        done = running.ctl("snapshot", "--force", folder / name)
        judge("a recording that runs is not replaced", done.returncode == 1, done.stderr)
    other = host("--config", "world.lua", "--duration", "1", "--record", "now.mcap.part", "--force", cwd=folder)
    judge("by another host neither", other.returncode == 2, other.stderr)
    running.stop()
    code, line, log = verify(folder / "now.mcap.part")
    judge("it is whole", code == 0 and not line["lacks"], log)

    (folder / "l.rsg").symlink_to("arm.urdf")
    for out in ("arm.urdf", "l.rsg", "./arm.urdf"):
        done = run("sparkhost", "--convert", "arm.urdf", out, "--force", cwd=folder)
        judge(f"--convert arm.urdf {out} is refused", done.returncode == 2 and model.read_text() == text, done.stderr)
    for arguments in (["--record", "world.lua"], ["--hashes", "world.lua"], ["--set", "logFile=world.lua"]):
        done = host("--config", "world.lua", "--duration", "0.2", "--force", *arguments, cwd=folder)
        judge(
            f"{arguments} over the config is refused",
            done.returncode == 2 and (folder / "world.lua").read_text() == WORLD,
            done.stderr,
        )
    os.mkfifo(folder / "pipe")
    outs = ["pipe"]
    try:
        os.mknod(folder / "null", stat.S_IFCHR | 0o666, os.makedev(1, 3))
        outs.append("null")
    except PermissionError:
        pass
    for out in outs:
        done = run("sparkhost", "--convert", "arm.urdf", out, "--force", cwd=folder)
        judge(
            f"--convert to a {out} is refused, and it stays",
            done.returncode == 2 and not stat.S_ISREG((folder / out).stat().st_mode),
            done.stderr,
        )
    left = [
        p.name
        for p in folder.iterdir()
        if ".mcap." in p.name or "draft" in p.name or p.name.startswith(("arm.urdf.", "pipe.", "null."))
    ]
    judge("no temporary file is left", sorted(left) == ["b.mcap.part", "c.mcap.part", "now.mcap.part"], left)
