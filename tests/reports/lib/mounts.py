"""Helpers of cases in which one host mounts the scene of another one."""
import signal
import subprocess
from pathlib import Path

from programs import BIN, Folder, Live, judge, verify

SERVES = """
include "house.lua"
include "materials.lua"
files() scene() materials() physics() simulation() control()
%s
"""
MOUNTS = """
include "house.lua"
include "materials.lua"
include "%s"
files() scene() materials() physics(engineOption()) simulation() agents{ port = 0 } control()
plugin "sensors"
get("/sys/server/simulation").rate = "max"
local room = new("Transform", "/usr/scene/room")
room.localPos = { 100, 0, 0 }
room:setLocalRotation(0, 0, 90)
local there = mount{ "/usr/scene/room/there", address = "%s", of = "/usr/scene" }
%s
print("right: the end")
"""


class Served(Live):
    """A host whose tree others mount at a socket in `folder`."""

    def __init__(self, folder, code):
        self.address = folder / "there.sock"
        (folder / "serves.lua").write_text(SERVES % code)
        super().__init__("--config", folder / "serves.lua", "--set", f"remoteAddress={self.address}",
                         "--log-level", "warning")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.communicate()


class Mounted:
    """A host that mounts the scene of `served` below a room and judges."""

    def __init__(self, folder, served, code, *arguments, **more):
        judges = Path(__file__).resolve().parent / "judge.lua"
        (folder / "mounts.lua").write_text(MOUNTS % (judges, served.address, code))
        command = (BIN / "sparkhost", "--config", folder / "mounts.lua", "--log-level", "info", *arguments)
        self.process = subprocess.Popen([str(a) for a in command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                        text=True, errors="replace", **more)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.communicate()

    def lines(self):
        """The lines of its log, to its end; says what its config has judged."""
        log = []
        for line in self.process.stderr:
            log.append(line)
            for verdict in ("right: ", "wrong: "):
                if verdict in line:
                    print(line[line.index(verdict):], end="")
            yield line
        code = self.process.wait()
        complete = any("right: the end" in line for line in log)
        judge("the host that mounts ends with 0", code == 0 and complete, f"{code} {''.join(log)}")


def mounted(folder, served, code, *arguments):
    """Such a host, to its end. Returns its log."""
    with Mounted(folder, served, code, "--rate", "max", *arguments) as host:
        return list(host.lines())


def freezes(served, mounted):
    """Such a host, recorded, in which the served one stops at the line "stop it" and goes on at "let it go on"."""
    with Folder() as folder, Served(folder, served) as server:
        with Mounted(folder, server, mounted, "--duration", "60", "--record", folder / "run.mcap") as host:
            for line in host.lines():
                if "stop it" in line:
                    server.process.send_signal(signal.SIGSTOP)
                elif "let it go on" in line:
                    server.process.send_signal(signal.SIGCONT)
        code, again, log = verify(folder / "run.mcap")
        good = code == 0 and again.get("differs", "") is None
        judge("the recording is simulated again", good, f"{code} {again} {log}")
