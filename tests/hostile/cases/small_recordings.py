#!/usr/bin/env python3
# row: B1
# input: small recordings whose summaries, chunks, channels or inputs expand to gigabytes
# right: each is read, or refused, with little memory and time
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "../reports/lib"))
sys.path.append(str(Path(__file__).resolve().parent.parent / "lib"))
import mcap  # noqa: E402
from pieces import piece_of_times  # noqa: E402
from programs import *  # noqa: E402,F403

import resource
import struct


def limits():
    resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))
    resource.setrlimit(resource.RLIMIT_CPU, (40, 40))


with Folder() as folder:
    host("--config", "world.lua", "--duration", "2", "--record", "a.mcap", cwd=folder)
    records = mcap.records(folder / "a.mcap")
    file = folder / "b.mcap"

    def tried(what, *commands):
        for command in commands:
            done = run("sparkreplay", file, *command, cwd=folder, preexec_fn=limits)
            judge(f"{what} ({file.stat().st_size >> 10} KB): {' '.join(command) or 'read'}",
                  done.returncode in (0, 1, 2) and "bad_alloc" not in done.stderr, f"{done.returncode} {done.stderr}")

    def index(op, place):
        at, length = place
        return (
            (13, struct.pack("<QQ", at, length) + mcap.text("x"))
            if op == mcap.METADATA
            else (10, struct.pack("<QQQQQ", at, length, 0, 0, 0) + mcap.text("x") + mcap.text("y"))
        )

    big = mcap.metadata("big", {"x": "y" * (256 << 10)})
    all_records = records + [big]
    mcap.write_with_summary(file, all_records, [index(mcap.METADATA, mcap.offsets(all_records)[-1])] * 20000)
    tried("one record of metadata, listed 20,000 times", [])
    long = mcap.attachment("n" * 60000, b"")
    all_records = records + [long]
    mcap.write_with_summary(file, all_records, [index(mcap.ATTACHMENT, mcap.offsets(all_records)[-1])] * 40000)
    tried("one attachment, listed 40,000 times", [])
    zeros = mcap.chunk(bytes(200 << 20))
    all_records = records + [zeros]
    place = mcap.offsets(all_records)[-1]
    entry = (
        8,
        struct.pack("<QQQQ", 0, 10**9, *place)
        + struct.pack("<IQ", 0, 0)
        + mcap.text("zstd")
        + struct.pack("<QQ", 0, 0),
    )
    mcap.write_with_summary(file, all_records, [entry] * 300)
    tried("one chunk of 200 MB, listed 300 times", [], ["--verify"], ["--export", "p.mcap"])
    bomb = [
        mcap.chunk(
            mcap.record(
                4, struct.pack("<HH", 100 + i, 0) + mcap.text("t" * (200 << 20)) + mcap.text("json") + mcap.text("")
            )
        )
        for i in range(6)
    ]
    mcap.write(file, bomb + records[1:])
    tried("six chunks with channels of 200 MB", [], ["--verify"], ["--export", "q.mcap"])
    # A thousand pieces of inputs of one time, each of which begins anew: 1.7 GB in memory.
    whole = mcap.unpacked(folder / "a.mcap")
    (channel,) = struct.unpack_from("<H", whole, whole.index(mcap.text("/spark/inputs")) - 4)
    after = 10**9 * 60
    message = mcap.record(5, struct.pack("<HIQQ", channel, 0, after, after) + piece_of_times(20000))
    mcap.write(file, records + [mcap.chunk(message * 1000, after, after)])
    tried("a thousand pieces of inputs of one time", ["--verify"])
    done = run("sparkreplay", file, "--verify", cwd=folder, preexec_fn=limits)
    judge("what is too much is named", "one time has more than 128 MB of inputs" in done.stdout + done.stderr, done)
    file.write_bytes((folder / "a.mcap").read_bytes())
    tried("and the recording as it was", ["--verify"])
