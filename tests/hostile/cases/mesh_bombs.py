#!/usr/bin/env python3
# row: B4
# input: a collider has a Collada file of 4 KB in which each of 26 nodes refers twice to the next; twenty more have
#   the same
# right: it is refused with the reason, the host stays small, and the file is read once
# slow: yes
"""The reader is a process of its own; what all of them took of the processor is that of one."""
import resource
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import host, judge  # noqa: E402

LEVELS = 26
CONFIG = """include "house.lua"
files() scene() physics() simulation()
local refused, why = 0, ""
for i = 1, 21 do
  local good, error = pcall(function()
    get("/usr/scene/space"):new("TriMeshCollider", "bomb" .. i).mesh = "models/bomb.dae"
  end)
  if not good then refused, why = refused + 1, tostring(error) end
end
log.error("refused: " .. refused .. " because " .. why)
"""


def collada():
    nodes = "".join(
        f'<node id="n{i}"><instance_node url="#n{i + 1}"/><instance_node url="#n{i + 1}"/></node>'
        for i in range(LEVELS)
    )
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset/>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="1">
<input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_nodes>{nodes}<node id="n{LEVELS}"><instance_geometry url="#g"/></node></library_nodes>
<library_visual_scenes><visual_scene id="s">
<node><instance_node url="#n0"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


def main():
    with tempfile.TemporaryDirectory() as folder:
        models = Path(folder, "models")
        models.mkdir()
        (models / "bomb.dae").write_text(collada())
        with host(
            "--scene-path", folder, "--rate", "max", "--duration", "0.1", "--log-level", "info", config=CONFIG
        ) as h:
            h.first_line()
            h.process.wait()
            h.reader.join()
            found = h.wait_for(r"refused: (\d+) because ([^\n]*\n[^\n]*)")
            judge(
                found and found[1] == "21", f"refused: {found and found[1]} of 21, {found and found[2].strip()[-120:]}"
            )
            judge("the reader" in h.text(), "the reason is that of the reader's limits")
    # The host's own children count, too: a reader has at most 10 s.
    took = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    judge(took < 30, f"all readers took {'less' if took < 30 else 'more'} than three times what one may")


main()
