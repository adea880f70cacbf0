"""Helpers of cases that run Spark's programs on files: a small world, runs of it, and verdicts."""
import json
import os
import subprocess
import tempfile
from pathlib import Path

BIN = Path(os.environ["SPARKBIN"])
# A pendulum that gets random pushes.
WORLD = """
include "house.lua"
files() scene() physics() simulation() control()
local arm = new("Transform", "/usr/scene/arm")
arm.localPos = { 0.4, 0, 3 }
local body = arm:new("RigidBody", "body")
body:setBoxTotal(1, 0.8, 0.05, 0.05)
local joint = arm:new("HingeJoint", "joint")
joint:attach("../body", "")
joint:setAnchor(-0.4, 0, 0)
joint:setAxis(0, 1, 0)
on("rule", function(_, event)
  if event.cycle % 10 == 0 then body:addForce(10 * (math.random() - 0.5), 0, 0) end
end)
"""


def judge(what, good, seen=""):
    print(f"{'right' if good else 'wrong'}: {what}{'' if good else f' ({str(seen).strip()[-400:]})'}", flush=True)


def run(program, *arguments, cwd=None, **more):
    """Runs a program to its end."""
    return subprocess.run(
        [a if isinstance(a, bytes) else str(a) for a in (BIN / program, *arguments)],
        capture_output=True,
        text=True,
        errors="replace",
        cwd=cwd,
        timeout=300,
        **more,
    )


def host(*arguments, cwd=None, **more):
    """Runs sparkhost as fast as it goes."""
    return run("sparkhost", "--rate", "max", "--log-level", "warning", *arguments, cwd=cwd, **more)


class Live:
    """A host that runs until stop(). Its first line has come."""

    def __init__(self, *arguments, cwd=None, **more):
        self.process = subprocess.Popen(
            [str(a) for a in (BIN / "sparkhost", "--log-level", "info", *arguments)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
            cwd=cwd,
            **more,
        )
        self.first = json.loads(self.process.stdout.readline())

    def ctl(self, *arguments):
        return run("sparkctl", "--pid", self.process.pid, *arguments)

    def stop(self):
        """(exit code, stderr)"""
        self.process.terminate()
        _, log = self.process.communicate(timeout=60)
        return self.process.returncode, log


class Folder(tempfile.TemporaryDirectory):
    """A folder with world.lua."""

    def __enter__(self):
        path = Path(super().__enter__()).resolve()
        (path / "world.lua").write_text(WORLD)
        return path


def verify(file, *arguments, cwd=None):
    """(exit code, the line of sparkreplay, stderr)"""
    done = run("sparkreplay", file, "--verify", *arguments, cwd=cwd)
    return done.returncode, json.loads(done.stdout) if done.stdout.strip() else {}, done.stderr
