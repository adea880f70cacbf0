"""A host and its clients, for cases of agents that come and go."""
import json
import os
import re
import signal
import socket
import struct
import subprocess
import tempfile
from pathlib import Path

PATIENCE = 100  # s, for a message


class Host:
    """sparkhost with free ports. Its log is in `log()`; close it by `with`."""

    def __init__(self, *arguments):
        self.errors = tempfile.TemporaryFile("w+")
        self.process = subprocess.Popen(
            [
                Path(os.environ["SPARKBIN"]) / "sparkhost",
                "--agent-port",
                "0",
                "--monitor-port",
                "0",
                "--web-port",
                "0",
                *arguments,
            ],
            stdout=subprocess.PIPE,
            stderr=self.errors,
            text=True,
        )
        self.ports = json.loads(self.process.stdout.readline())

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()

    def end(self):
        """Its last line of stdout, after SIGTERM."""
        self.process.send_signal(signal.SIGTERM)
        return json.loads(self.process.stdout.read().splitlines()[-1])

    def log(self):
        self.errors.seek(0)
        return self.errors.read()


class Client:
    """A connection with messages of a length and a text."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), PATIENCE)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def send(self, message):
        data = message if isinstance(message, bytes) else message.encode()
        self.socket.sendall(struct.pack(">I", len(data)) + data)

    def receive(self):
        return self.receive_bytes().decode()

    def receive_bytes(self):
        return self._read(struct.unpack(">I", self._read(4))[0])

    def _read(self, count):
        data = b""
        while len(data) < count:
            part = self.socket.recv(count - len(data))
            if not part:
                raise EOFError("the host closed the connection")
            data += part
        return data

    def close(self):
        self.socket.close()


def join(port, team, number, cycles=15, answer="(syn)"):
    """A sphere that joins a team, and its side: "left", "right", or None if it was not told one within `cycles`."""
    client = Client(port)
    client.send("(scene rsg/agent/sphere.rsg)" + answer)
    client.receive()
    client.send(f"(init (unum {number})(teamname {team}))" + answer)
    return client, side(client, cycles, answer)


def side(client, cycles, answer="(syn)"):
    for _ in range(cycles):
        message = client.receive()
        client.send(answer)
        told = re.search(r"\(team (left|right)\)", message)
        if told:
            return told[1]
    return None


def judge(what, good):
    print(("right: " if good else "wrong: ") + what)
