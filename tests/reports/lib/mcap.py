"""Reads and forges MCAP files, record by record: https://mcap.dev/spec."""
import ctypes
import ctypes.util
import json
import struct

MAGIC = b"\x89MCAP0\r\n"
CHUNK, ATTACHMENT, METADATA, DATA_END = 6, 9, 12, 15


def text(value):
    data = value if isinstance(value, bytes) else value.encode()
    return struct.pack("<I", len(data)) + data


def records(file):
    """[(opcode, content)] up to the end of the data"""
    data, at, out = file.read_bytes(), len(MAGIC), []
    while at + 9 <= len(data):
        op, length = struct.unpack_from("<BQ", data, at)
        if op == DATA_END:
            break
        out.append((op, data[at + 9:at + 9 + length]))
        at += 9 + length
    return out


def record(op, content):
    return struct.pack("<BQ", op, len(content)) + content


def write(file, all_records):
    """A file without a summary."""
    file.write_bytes(MAGIC + b"".join(record(op, content) for op, content in all_records))


def write_with_summary(file, all_records, summary):
    """A file with a forged summary: its records, which may refer to offsets(all_records)."""
    data = MAGIC + b"".join(record(op, content) for op, content in all_records) + record(DATA_END, struct.pack("<I", 0))
    start = len(data)
    data += b"".join(record(op, content) for op, content in summary)
    file.write_bytes(data + record(2, struct.pack("<QQI", start, 0, 0)) + MAGIC)


def offsets(all_records):
    """Where write() puts them: [(offset, length)]"""
    at, out = len(MAGIC), []
    for _, content in all_records:
        out.append((at, 9 + len(content)))
        at += 9 + len(content)
    return out


def attachment(name, data):
    return ATTACHMENT, struct.pack("<QQ", 0, 0) + text(name) + text("application/octet-stream") + struct.pack(
        "<Q", len(data)
    ) + data + bytes(4)


def metadata(name, values):
    return METADATA, text(name) + text(b"".join(text(k) + text(v) for k, v in values.items()))


def about(all_records):
    """The values of the metadata "spark"."""
    for op, content in all_records:
        if op != METADATA:
            continue
        at, words = 0, []

        def take():
            nonlocal at
            (n,) = struct.unpack_from("<I", content, at)
            at += 4 + n
            return content[at - n:at].decode()

        if take() != "spark":
            continue
        at += 4
        while at < len(content):
            words.append(take())
        return dict(zip(words[::2], words[1::2]))
    return {}


def forged(all_records, arguments=None, scripts=None, attachments=()):
    """The records with another command line, other scripts by name, and further attachments in front."""
    values = about(all_records)
    if arguments is not None:
        values["arguments"] = json.dumps(arguments)
    front = [attachment(name, data) for name, data in attachments]
    front += [attachment("script:" + name, data.encode()) for name, data in (scripts or {}).items()]
    # The first attachment of a name counts.
    return (
        [r for r in all_records[:1]]
        + front
        + [metadata("spark", values) if op == METADATA else (op, c) for op, c in all_records[1:]]
    )


def zstd(function, data, room):
    library = ctypes.CDLL(ctypes.util.find_library("zstd") or "libzstd.so.1")
    out = ctypes.create_string_buffer(room)
    call = getattr(library, function)
    call.restype = ctypes.c_size_t
    arguments = (out, ctypes.c_size_t(room), data, ctypes.c_size_t(len(data))) + (
        (ctypes.c_int(3),) if function == "ZSTD_compress" else ()
    )
    n = call(*arguments)
    return out.raw[:n]


def unpacked(file):
    """All bytes of a file, those of its chunks decompressed."""
    out = b""
    for op, content in records(file):
        if op == CHUNK:
            size, _, n = struct.unpack_from("<QII", content, 16)
            at = 32 + n
            content = zstd("ZSTD_decompress", content[at + 8:], size)
        out += content
    return out


def chunk(contents, begin=0, end=0):
    """A chunk of records, compressed."""
    packed = zstd("ZSTD_compress", contents, len(contents) // 100 + (1 << 20))
    return (
        CHUNK,
        struct.pack("<QQQI", begin, end, len(contents), 0) + text("zstd") + struct.pack("<Q", len(packed)) + packed,
    )
