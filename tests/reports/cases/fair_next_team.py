#!/usr/bin/env python3
# row: 19
# input: teams leave one after the other, and the next opponents come to the same server
# right: a new team takes the side of one that has left, without its goals; while two play a third is refused; a team
#   that comes back to its side goes on
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parent.parent / "lib"))
from client import Client, Host, join, judge  # noqa: E402


def main():
    with Host("--config", "soccer-sphere.lua", "--set", "Soccer.WaitBeforeKickOff=1000") as host:
        port = host.ports["agentPort"]
        red, side = join(port, "Red", 1)
        judge(f"the first team plays {side}", side == "left")
        blue, side = join(port, "Blue", 1)
        judge(f"the second team plays {side}", side == "right")
        third, side = join(port, "Green", 1)
        judge(f"a third team plays {side}", side is None)
        third.close()
        Client(host.ports["monitorPort"]).send("(score (left 3)(right 1))")
        red.close()
        green, side = join(port, "Green", 1)
        judge(f"after the first has left, the third team plays {side}", side == "left")
        red, side = join(port, "Red", 1)
        judge(f"the first team comes back, and plays {side}", side is None)
        blue.close()
        blue, side = join(port, "Blue", 1)
        judge(f"the second team leaves, comes back, and plays {side}", side == "right")
        end = host.end()
        judge(
            f"the score of {' and '.join(end['teams'])} is {end['score']}",
            end["teams"] == ["Green", "Blue"] and end["score"] == [0, 1],
        )


main()
