#!/usr/bin/env python3
# row: 19
# input: a player hangs: it neither reads nor answers, and stays connected; its program is started again, in real time
#   and in lockstep
# right: the new connection plays with its number; while the old one still answers, the new one is refused
import sys
import threading
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parent.parent / "lib"))
from client import Host, join, judge  # noqa: E402


def real_time():
    with Host("--config", "soccer-sphere.lua", "--set", "Soccer.WaitBeforeKickOff=1000") as host:
        port = host.ports["agentPort"]
        old, _ = join(port, "Red", 3)
        stop = threading.Event()

        def plays():
            while not stop.is_set():
                old.receive()
                old.send("(drive 0 0 0)")

        playing = threading.Thread(target=plays)
        playing.start()
        new, told = join(port, "Red", 3, 50)
        judge(f"real time: beside a player that answers the new one plays {told}", told is None)
        new.close()
        stop.set()
        playing.join()
        new, told = join(port, "Red", 3, 1500)
        judge(f"real time: after it hung, the new one plays {told}", told == "left")


def lockstep():
    with Host(
        "--config", "soccer-sphere.lua", "--sync", "--rate", "max", "--set", "/sys/server/gamecontrol.answerWait=0.1"
    ) as host:
        port = host.ports["agentPort"]
        old, _ = join(port, "Red", 3)
        new, told = join(port, "Red", 3, 50)
        judge(f"lockstep: after it hung, the new one plays {told}", told == "left")
        judge("the log says that the old one gave way", "gives way to its successor" in host.log())


if __name__ == "__main__":
    both = [threading.Thread(target=real_time), threading.Thread(target=lockstep)]
    for t in both:
        t.start()
    for t in both:
        t.join()
