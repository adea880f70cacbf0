#!/usr/bin/env python3
# row: C6
# input: a simulator that sends malformed numbers to sparkcomm, starts 400 agents, and then plays with one of them
# right: sparkcomm lives, starts as many as --most says, and its agents go on
import socket
import struct
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import Program, judge  # noqa: E402
import wire  # noqa: E402

AGENT = """#!/usr/bin/env python3
import os, struct
while (head := os.read(3, 4)):
    said = os.read(3, struct.unpack('>I', head)[0])
    answer = b'Aheard ' + said[1:] if said[:1] == b'S' else b'I'
    os.write(4, struct.pack('>I', len(answer)) + answer)
"""
# Hears and never answers.
IDLE = """#!/usr/bin/env python3
import os
while os.read(3, 1):
    pass
"""
DATABASE = """<agentdb>
<agent_type_external name="echo"><timer>fixed 1</timer><exec_line>agent.py</exec_line></agent_type_external>
<agent_type_external name="idle"><timer>fixed 1</timer><exec_line>idle.py</exec_line></agent_type_external>
</agentdb>"""
NONSENSE = ["start", "start x", "start -1 1 idle", "start 1e9 1 idle", "start 99999999999999999999999 1 idle",
            "start 7 seven idle", "start 8 1 nobody", "to", "to x D", "to 123 D", "to 18446744073709551616 D", "\x00"]


def say(client, text):
    data = text.encode()
    client.sendall(struct.pack(">I", len(data)) + data)


def main():
    with tempfile.TemporaryDirectory() as name, socket.create_server(("127.0.0.1", 0)) as server:
        folder = Path(name)
        for program, text in (("agent.py", AGENT), ("idle.py", IDLE)):
            (folder / program).write_text(text)
            (folder / program).chmod(0o755)
        (folder / "db.xml").write_text(DATABASE)
        with Program("sparkcomm", "--port", server.getsockname()[1], "--database", folder / "db.xml", "--most", "3",
                     "--patience", "20") as comm:
            server.settimeout(30)
            client, _ = server.accept()
            wire.receive(client)
            say(client, "W0")
            say(client, "Mstart 1 1 echo")
            for text in NONSENSE:
                say(client, "M" + text)
            for number in range(400):
                say(client, f"Mstart {1000 + number} {number} idle")
            say(client, "Mto 1 S0 0 (marker)")
            lost, heard = set(), False
            while not heard or len(lost) < 398:
                try:
                    message = wire.receive(client)
                except (EOFError, OSError):
                    break
                if message.startswith(b"Mlost 1") and int(message.split()[1]) >= 1000:
                    lost.add(int(message.split()[1]))
                heard |= message.startswith(b"Mfrom 1 ") and b"(marker)" in message
            judge(heard, "the agent that plays is answered")
            judge(len(lost) == 398, f"of 400 more agents {400 - len(lost)} run")
            say(client, "Mend")
            comm.process.wait()
            comm.reader.join()
            judge(comm.process.returncode == 0, f"it ends with exit code {comm.process.returncode}")
            judge(comm.text().count("makes no sense") == 1, "one line says that it makes no sense")


main()
