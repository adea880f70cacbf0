#!/usr/bin/env python3
# row: A3
# input: tokens in options, requests and made up ones, in a host that records, is watched and makes snapshots
# right: no recording, snapshot or property has them
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "../reports/lib"))
import mcap  # noqa: E402
from programs import *  # noqa: E402,F403

SECRETS = {
    "webToken": "web-0123456789abcdef",
    "remoteToken": "rem-0123456789abcdef",
    "commToken": "com-0123456789abcdef",
    "mine": "my-0123456789abcdef",
}
PUBLIC = "pub-0123456789abcdef"  # the value of an option that is no secret: it is found wherever the others must not be
CONFIG = """
include "house.lua"
option{ name = "shown", default = "" }
files() scene() physics() simulation()
plugin "gamecontrol"
spades{ types = "", players = 0 }
monitors{ port = 0 }
web() control()
local mine = option{ name = "mine", default = "", secret = true }
new("SpadesServer", "/usr/second"):setToken(mine)
"""
with Folder() as folder:
    (folder / "served.lua").write_text(CONFIG)
    sets = [word for key, value in SECRETS.items() for word in ("--set", f"{key}={value}")]
    sets[1:2] = []
    sets += ["--set", f"shown={PUBLIC}"]
    sets[0] = f"--set=webToken={SECRETS['webToken']}"
    running = Live(
        "--config",
        "served.lua",
        "--record",
        "a.mcap",
        "--web-port",
        "0",
        "--set",
        "remoteAddress=127.0.0.1:0",
        *sets,
        cwd=folder,
    )
    later = "called-0123456789abcdef"
    done = running.ctl("call", "/usr/second.setToken", later)
    judge("a token may be set while it runs", done.returncode == 0, done.stderr)
    seen = "".join(
        running.ctl("get", path).stdout
        for path in (
            "/sys/host/snapshots",
            "/sys/host/tape",
            "/sys/server/web",
            "/sys/server/spades",
            "/sys/server/remote",
            "/sys/server/script",
            "/usr/second",
            "/sys/server/log",
        )
    )
    running.ctl("snapshot", folder / "s.mcap")
    code, log = running.stop()
    judge("it ended well", code == 0 and "arguments" in seen, log + seen)
    judge("what is no secret is read", PUBLIC in seen, seen)
    for file in ("a.mcap", "s.mcap"):
        judge(f"what is no secret is in {file}", PUBLIC.encode() in mcap.unpacked(folder / file))
    # What the inputs of a recording have is coded: tests/system/recording_test.cpp decodes them.
    for name, secret in {**SECRETS, "a call": later}.items():
        judge(f"{name} is no property", secret not in seen, seen)
        for file in ("a.mcap", "s.mcap"):
            judge(
                f"{name} is not in {file}",
                secret.encode() not in mcap.unpacked(folder / file)
                and secret.encode() not in (folder / file).read_bytes(),
            )
    code, line, log = verify(folder / "a.mcap")
    judge("the recording verifies", code == 0 and line.get("differs", 1) is None, log)
    on = host("--from", "a.mcap", "--duration", "3", "--web-port", "0", cwd=folder)
    judge("a run that goes on says which secret it lacks", "commToken" in on.stderr, on.stderr)
