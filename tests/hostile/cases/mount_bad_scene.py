#!/usr/bin/env python3
# row: B3
# input: the scene of a mounted host has poses, shapes and looks that are no numbers or beyond all measure, files for meshes, and calls that make no scene
# right: each costs its node alone, with a line in the log; the others are there, and the simulation goes on
# engines: all
import socket
import sys
import threading
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import host, judge  # noqa: E402
from wire import message, receive  # noqa: E402

CONFIG = """include "house.lua"
files() scene() physics(engineOption()) simulation()
new("Transform", "/usr/scene/room").localPos = { 10, 0, 0 }
local floor = new("BoxCollider", "/usr/scene/floor")
floor:setBoxLengths(4, 4, 1)
local ball = new("Transform", "/usr/scene/ball")
ball.localPos = { 0, 0, 1 }
ball:new("RigidBody", "body"):setSphereTotal(1, 0.2)
ball:new("SphereCollider", "shape").radius = 0.2
local there = mount{ "/usr/scene/room/there", address = "127.0.0.1:%d", token = "0123456789abcdef" }
local function judge(good, what) print((good and "right: " or "wrong: ") .. what) end
on("rule", function(_, event)
  if event.cycle ~= 50 then return end
  local hit = get("/sys/server/physics"):castRay({ 10, 0, 5 }, { 0, 0, -1 }, 20)
  judge(hit and math.abs(hit[1] - 4.5) < 1e-5 and hit[2] == "/usr/scene/room/there/good/shape",
        "the good node is there: " .. tostring(hit and hit[2]))
  judge(math.abs(ball.localPos[3] - 0.7) < 0.25, "the ball lies on the floor: " .. ball.localPos[3])
  local wild = {}
  local function walk(node)
    if node:isA("Transform") then
      for _, n in ipairs(node.localTransform) do if not (math.abs(n) <= 1e9) then wild[#wild + 1] = node.path end end
    end
    for _, child in ipairs(node:children()) do walk(child) end
  end
  walk(get("/usr/scene"))
  judge(#wild == 0, "all poses are numbers: " .. table.concat(wild, " "))
  judge(there:find("name") == nil and there:find("good") ~= nil, "no node was renamed by a property")
  judge(there.connected, "the link stays")
  judge(#get("/usr/scene/room"):children() == 1, "nothing was made beside the mount")
end)
"""
ONE = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]
NODE, COLLIDER = ["BaseNode", "Node", "Leaf"], ["Collider", "BaseNode", "Node", "Leaf"]
BASES = {
    "Transform": NODE,
    "SphereCollider": COLLIDER,
    "BoxCollider": COLLIDER,
    "ConvexCollider": COLLIDER,
    "TriMeshCollider": ["ConcaveCollider", *COLLIDER],
    "HeightFieldCollider": ["ConcaveCollider", *COLLIDER],
    "ContactJointHandler": ["CollisionHandler", *NODE],
    "StaticMesh": ["RenderNode", *NODE],
    "Box": ["SingleMatNode", "StaticMesh", "RenderNode", *NODE],
    "Light": NODE,
    "World": NODE,
    "Strange": ["Transform"],
    "RigidBody": ["Body", *NODE],
    "ScriptBehavior": ["Transform", "BaseNode"],
}
TURN = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
CORNERS = [0.0, 0.0, 50.0, 1.0, 0.0, 50.0]
NAN, INF, FAR, TINY = float("nan"), float("inf"), 1e308, 1e-320


def pose(index, number):
    return ONE[:index] + [number] + ONE[index + 1:]


def nodes():
    """(class, what it is)"""
    for number in (NAN, INF, -INF, FAR, 2e9, "x"):
        for index in (0, 3, 13, 15):
            yield "Transform", [pose(index, number), [], []]
    yield "Transform", [[], [], []]
    yield "Transform", [ONE[:7], [["importScene", ["/etc/passwd"]]], [["localTransform", pose(12, NAN)]]]
    yield "Strange", [pose(0, 1e9), [["importScene", ["x.rsg"]], ["unlinkLeaf", []]], [["name", "name"]]]
    yield "World", [[], [], [["gravity", [0.0, 0.0, FAR]]]]
    yield "RigidBody", [[], [], [["mass", NAN]]]
    yield "ScriptBehavior", [ONE, [], []]
    for number in (NAN, INF, FAR, TINY, -1.0, 1e20):
        yield "SphereCollider", [[], [], [["radius", number]]]
        yield "BoxCollider", [[], [], [["boxLengths", [number, 1.0, 1.0]]]]
        yield "BoxCollider", [[], [["setLocalPose", [number, 0.0, 50.0, *TURN]]], []]
        yield "BoxCollider", [[], [["setLocalPose", [0.0, 0.0, 50.0] + [number] * 9]], []]
        yield "ConvexCollider", [[], [], [["points", [*CORNERS, 0.0, 1.0, 50.0, 0.0, 0.0, number]]]]
        yield "TriMeshCollider", [[], [], [["vertices", [*CORNERS, 0.0, 1.0, number]], ["triangles", [0, 1, 2]]]]
        yield "TriMeshCollider", [[], [], [["vertices", [0.0, 0.0, 50.0]], ["triangles", [0, 1, 7]]]]
        heights = ["heights", [0.0, 0.0, 0.0, number]]
        yield "HeightFieldCollider", [[], [], [["columns", 2], heights, ["size", [number, 1.0, 1.0]]]]
        yield "ContactJointHandler", [[], [], [["contactMu", number], ["contactSoftCFM", number]]]
        yield "Box", [[], [["setScale", [number, 1.0, 1.0]], ["load", ["StdUnitBox", number]]], []]
        yield "Light", [[], [], [["diffuse", [number, 0.0, 0.0, 1.0]], ["radius", number]]]
    yield "TriMeshCollider", [[], [], [["mesh", "/etc/passwd"], ["scale", [0.0, 0.0, 0.0]]]]
    yield "ConvexCollider", [[], [], [["mesh", "../../../../etc/passwd"]]]
    calls = [["load", ["/etc/passwd"]], ["resetMaterials", ["m"] * 1000], ["addCollisionHandler", ["ScriptHandler"]]]
    yield "StaticMesh", [[], calls, []]
    yield "SphereCollider", "no list"
    yield "SphereCollider", [1, 2, 3]
    yield "SphereCollider", [[], [5, [], ["setLocalPose"]], [7, ["radius"]]]


class Evil(threading.Thread):
    def __init__(self):
        super().__init__(daemon=True)
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]

    def run(self):
        try:
            client, _ = self.listener.accept()
            receive(client)  # hello
            client.sendall(message("welcome", 1))
            for name, bases in BASES.items():
                client.sendall(message("class", name, "", bases[0], "", "", [], [], bases))
            client.sendall(message("add", 1, 0, "good", "Transform", [ONE, [], []]))
            client.sendall(message("add", 2, 1, "shape", "BoxCollider", [[], [], [["boxLengths", [1.0, 1.0, 1.0]]]]))
            all = list(nodes())
            for n, (name, state) in enumerate(all):
                client.sendall(message("add", 10 + 2 * n, 0, f"n{n}", "Transform", [pose(12, 1000.0), [], []]))
                client.sendall(message("add", 11 + 2 * n, 10 + 2 * n, "bad", name, state))
            receive(client)  # get
            client.sendall(message("ok", 1, "match"))
            receive(client)  # ready: the run loop runs
            # The same once more, of nodes that are there, and of some that are not.
            whole = [(11 + 2 * n, state) for n, (_, state) in enumerate(all)
                     if len(state) == 3 and isinstance(state[1], list)]
            poses = [[node, state[0]] for node, state in whole if len(state[0]) == 16]
            looks = [[node, state[1], state[2]] for node, state in whole]
            for n in range(30):
                values = [[1, "localPos", [NAN]], [10**9, "x", 1]]
                client.sendall(message("scene", n + 1, poses + [[10**9, ONE]], looks, values))
            while client.recv(4096):
                pass
        except (OSError, EOFError):
            pass


evil = Evil()
evil.start()
with host("--rate", "max", "--duration", "1.2", "--set", f"engine={sys.argv[1]}", config=CONFIG % evil.port) as h:
    h.first_line()
    last = h.last_line()
    log = h.text()
    for line in log.splitlines():
        for verdict in ("right: ", "wrong: "):
            if verdict in line:
                print(line[line.index(verdict):])
    judge(h.process.returncode == 0 and last and last["cycles"] == 60, f"{last and last['cycles']} cycles of 60")
    judge(log.count("this scene cannot have") < 40, f"{log.count('this scene cannot have')} lines")
