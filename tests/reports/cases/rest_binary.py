# row: p64
# input: an agent sends each byte bare and in quotes, a percept holds all bytes, in S-expressions and JSON
# right: a bad byte costs its predicate, quoted text is whole in both directions, and lockstep goes on
import json
import re
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "lib"))
from client import Client, Host, judge  # noqa: E402

CONFIG = """
include "house.lua"
files() scene() physics() simulation()
local agents = agents{}
monitors{} web()
plugin "parser-json"
plugin "effectors"
agentPort("json", 0, "JsonParser")
get("/sys/server/net/json/parser").binary = true
local letter = ""
agents:new("ScriptAspect", "post"):on("agentConnected", function(self, event)
  local robot = get(event.data)
  robot:new("ScriptEffector", "write"):on("perform", function(self, event) letter = event.data[2] end)
  robot:new("ScriptPerceptor", "letter"):on("perceive", function() return { { "text", letter } } end)
  robot:new("AgentSyncEffector", "syn")
end)
"""
ALL = bytes(range(256))


class Agent(Client):
    """An agent in lockstep: one message to the host, one from it."""

    def exchange(self, message):
        self.send(message)
        return self.receive_bytes()


def quoted(data):
    return b'"' + data.replace(b"\\", b"\\\\").replace(b'"', b'\\"') + b'"'


def unquoted(message):
    """The text of (letter (text "...")) in a message of the host."""
    out, at = b"", message.index(b'(text "') + 7
    while message[at:at + 1] != b'"':
        at += message[at:at + 1] == b"\\"
        out += message[at:at + 1]
        at += 1
    return out


def heard(agent, message, syn, expected):
    """Whether a percept within four cycles has the expected text; without (syn) the host would not go on."""
    for _ in range(4):
        if expected(agent.exchange(message)):
            return True
        message = syn
    return False


def of_json(message):
    return [p[1][1] for p in json.loads(message) if p[0] == "letter"]


with tempfile.TemporaryDirectory() as folder:
    config = Path(folder) / "config.lua"
    config.write_text(CONFIG)
    with Host("--config", str(config), "--rate", "max", "--sync") as host:
        agent = Agent(host.ports["agentPort"])
        agent.exchange(b"(syn)")
        bad = [c for c in range(256) if chr(c) not in "(;\\" and c < 0x80 and not chr(c).isalnum()]
        lost = []
        for c in bad:
            mark = b"m%d" % c
            message = b"(write " + mark + b")(write a" + bytes([c]) + b"b)(syn)"
            if c == 0 or c < 0x20 and c not in b"\t\r\n" or c == 0x7F:
                if not heard(agent, message, b"(syn)", lambda m: mark in m):
                    lost.append(c)
            else:
                agent.exchange(message)
        judge(f"{len(bad)} bytes in a bare word: what is beside them counts, lost: {lost}", not lost)
        judge("quoted text brings bytes 0 to 255 and back",
              heard(agent, b"(write " + quoted(ALL) + b")(syn)", b"(syn)",
                    lambda m: b'(text "' in m and unquoted(m) == ALL))
        judge("an empty text is one", heard(agent, b'(write "")(syn)', b"(syn)", lambda m: b'(text "")' in m))
        judge("a word stays one without quotes",
              heard(agent, b"(write word)(syn)", b"(syn)", lambda m: b"(text word)" in m))
        judge("a text of digits in quotes is text",
              heard(agent, b'(write "1 2")(syn)', b"(syn)", lambda m: b'(text "1 2")' in m))
        judge("the log names a byte",
              "byte 0x00 is no part of an atom at 1:19; that predicate is ignored." in host.log())
    with Host("--config", str(config), "--rate", "max", "--sync") as host:
        agent = Agent(int(re.search(r"Port json: listening on .*:(\d+)\.", host.log())[1]))
        agent.exchange(b'["syn"]')
        syn = b'["syn"]'
        judge("in JSON a bad byte costs its predicate",
              heard(agent, b'[["write","kept"],["write","a\x01b"],["syn"]]', syn, lambda m: of_json(m) == ["kept"]))
        text = ALL.decode("latin-1")
        judge("in JSON with `binary` bytes 0 to 255 come and go",
              heard(agent, json.dumps([["write", text], ["syn"]]).encode(), syn, lambda m: of_json(m) == [text]))
