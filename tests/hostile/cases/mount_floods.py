#!/usr/bin/env python3
# row: B3
# input: a host mounts another one that then sends without end: descriptions of classes, nodes, events, poses and
#   values, moves that are never possible with nodes behind them
# right: the simulation goes on to its end, in little memory
"""Each kind is a host of its own, which answers as a host does before it floods."""
import socket
import sys
import threading
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import host, judge  # noqa: E402
from wire import message, receive  # noqa: E402

MOST = 600  # MB
CONFIG = """include "house.lua"
simulation()
mount{ "/usr/match", address = "127.0.0.1:%d", token = "0123456789abcdef" }
"""
BEGIN = (
    message("class", "Node", "A node.", "Leaf", "", "", [], [])
    + message("add", 1, 0, "a", "Node")
    + message("add", 2, 1, "b", "Node")
)


def classes():
    for n in range(10**9):
        yield b"".join(
            message(
                "class", f"C{n % 50}", f"{n} {i}", "Leaf", "", "", [["p", "number", "m", "x", False, False, 1]] * 20, []
            )
            for i in range(50)
        )


def other_classes():
    for n in range(10**9):
        yield b"".join(message("class", f"C{n} {i}", "x" * 1000, "Leaf", "", "", [], []) for i in range(50))


def nodes():
    for n in range(10**9):
        yield b"".join(message("add", 10 + 100 * n + i, 0, "n", "Node") for i in range(100))


def comes_and_goes():
    for n in range(10**9):
        yield b"".join(
            message("add", 10 + n, 0, "n", "Node") + message("rename", 10 + n, "m") + message("remove", 10 + n)
            for _ in range(100)
        )


def events():
    part = message("event", 0, 1, 0.0, 0.02, 1, "x" * 500, False) * 200
    while True:
        yield part


def scenes():
    one = [1.0 if n % 5 == 0 else 0.0 for n in range(16)]
    for n in range(10**9):
        yield message(
            "scene",
            n + 1,
            [[1 + k % 2, one] for k in range(1000)],
            [[1, [], [["name", f"{n}"]]]] * 100,
            [[1, "name", f"{n}"]] * 100,
        )


def fat_scenes():
    for n in range(10**9):
        yield message("scene", n + 1, [], [], [[1, "name", "x" * 1000]] * 2000)


def stuck():
    yield message("move", 1, 2)
    yield from nodes()


def unknown_class():
    yield message("rename", 1, "c") + message("add", 3, 0, "n", "Unheard")
    yield from nodes()


def silent_after_half():
    yield message("add", 3, 0, "n", "Node")[:-7]
    while True:
        yield b""


class Evil(threading.Thread):
    def __init__(self, flood):
        super().__init__(daemon=True)
        self.flood, self.listener = flood, socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]

    def run(self):
        try:
            client, _ = self.listener.accept()
            receive(client)  # hello
            client.sendall(message("welcome", 1) + BEGIN)
            receive(client)  # get
            client.sendall(message("ok", 1, "match"))
            receive(client)  # ready: the run loop runs
            for part in self.flood():
                if not part:
                    client.recv(1)
                client.sendall(part)
        except (OSError, EOFError):
            pass


def main():
    for flood in (
        classes,
        other_classes,
        nodes,
        comes_and_goes,
        events,
        scenes,
        fat_scenes,
        stuck,
        unknown_class,
        silent_after_half,
    ):
        evil = Evil(flood)
        evil.start()
        with host("--rate", "max", "--duration", "1", "--log-level", "warning", config=CONFIG % evil.port) as h:
            h.first_line()
            # The memory is read until the program is gone.
            memory, ended = 0, threading.Event()
            threading.Thread(target=lambda p=h.process, e=ended: (p.wait(), e.set()), daemon=True).start()
            while not ended.wait(0.05):
                try:
                    memory = max(memory, h.memory())
                except (OSError, TypeError):
                    break
            last = h.last_line()
            judge(
                h.process.returncode == 0 and last and last["cycles"] == 50,
                f"{flood.__name__}: {last and last['cycles']} cycles of 50",
            )
            judge(memory < MOST, f"{flood.__name__}: {'less' if memory < MOST else 'more'} than {MOST} MB")


main()
