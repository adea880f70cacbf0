#!/usr/bin/env python3
# row: p18
# input: sparkwatch at hosts that end, that leave in the middle of a message, that send what is no message, and at none
# right: exit code 0 with the end of a host; else 1 and a sentence, also after the first message
import socket
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from client import PATIENCE, Host, judge  # noqa: E402
from programs import BIN  # noqa: E402

SCENE = "(RSG 0 1)((nd TRF (SLT 1 0 0 0 0 1 0 0 0 0 1 0 2 3 4 1)(nd StaticMesh (load StdUnitBox) (sSc 1 1 1))))"
MOVE = "(RDS 0 1)((nd TRF (SLT 1 0 0 0 0 1 0 0 0 0 1 0 3 3 4 1)(nd StaticMesh)))"


def framed(text):
    data = text if isinstance(text, bytes) else text.encode()
    return struct.pack(">I", len(data)) + data


def watching(*arguments):
    return subprocess.Popen([BIN / "sparkwatch", *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            text=True)


def watch(data, *arguments, reset=False):
    """A host that sends some bytes and leaves."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        program = watching("--port", server.getsockname()[1], *arguments)
        server.settimeout(PATIENCE)
        host, _ = server.accept()
        host.sendall(data)
        if reset:
            host.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            program.stdout.readline()
        host.close()
        out, errors = program.communicate()
        return program.returncode, len(out.splitlines()), errors.strip()


first = framed("((time 0.1))" + SCENE)
CASES = (
    ("the end of a host", first + framed("((time 0.2))" + MOVE), [], 0, ""),
    ("an end before the messages that were asked for", first, ["--messages", "3"], 1, "closed the connection"),
    ("an end in the middle of a message", first + first[:40], [], 1, "in the middle of a message"),
    ("an end in the middle of a length", first + first[:2], [], 1, "in the middle of a message"),
    ("an empty message", first + framed(""), [], 1, "no message of a monitor port"),
    ("a message without an end", first + framed("((time 0.2)"), [], 1, "no message of a monitor port"),
    ("a scene without an end", first + framed("((time 0.2))" + SCENE[:50]), [], 1, "frame.rsg"),
    ("another language", first + framed('{"time":0.2}'), [], 1, "no message of a monitor port"),
    ("another protocol", first + b"HTTP/1.1 200 OK\r\n\r\n", [], 1, "another protocol"),
    ("no message at all", b"", [], 1, "closed the connection"),
)
for what, data, arguments, right, why in CASES:
    code, lines, errors = watch(data, *arguments)
    good = code == right and why in errors and (errors == "") == (right == 0) and "\n" not in errors
    judge(f"{what}: {code} {errors}", good and (lines >= 1 or not data))
code, lines, errors = watch(first, reset=True)
judge(f"a connection that breaks: {code} {errors}", code == 1 and "broke" in errors)
with tempfile.TemporaryDirectory() as folder:
    config = Path(folder) / "config.lua"
    config.write_text('include "house.lua" files() scene() simulation() agents{} monitors{} web()\n'
                      'new("Transform", "/usr/scene/a"):new("SingleMatNode", "b"):load("StdUnitBox")')
    for rate in ("real", "max"):
        with Host("--config", str(config), "--rate", rate) as host:
            port = host.ports["monitorPort"]
            program = watching("--port", port)
            program.stdout.readline()
            host.end()
            errors = program.communicate()[1]
            judge(f"a host that ends, at rate {rate}: {program.returncode} {errors}", program.returncode == 0)
