"""Messages of remote hosts: lists of values, each with its length before it."""
import socket
import struct


def word(n):
    return struct.pack("<Q", n & 0xFFFFFFFFFFFFFFFF)


def value(v):
    """The bytes of a value."""
    if v is None:
        return word(0)
    if isinstance(v, bool):
        return word(1) + word(v)
    if isinstance(v, int):
        return word(2) + word(v)
    if isinstance(v, float):
        return word(3) + struct.pack("<d", v)
    if isinstance(v, str):
        text = v.encode()
        return word(4) + word(len(text)) + text + b"\0" * (-len(text) % 8)
    return word(5) + word(len(v)) + b"".join(map(value, v))


def message(*parts):
    body = value(parts)
    return struct.pack(">I", len(body)) + body


def exactly(client, count):
    data = b""
    while len(data) < count:
        part = client.recv(count - len(data))
        if not part:
            raise EOFError("the connection ended")
        data += part
    return data


def receive(client):
    """The bytes of one message."""
    return exactly(client, struct.unpack(">I", exactly(client, 4))[0])


def has(body, text):
    """Whether a message contains a text."""
    return value(text)[16:] in body or text.encode() in body


def connect(port):
    return socket.create_connection(("127.0.0.1", port))
