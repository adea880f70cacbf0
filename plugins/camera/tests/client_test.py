"""Runs the client of the README against sparkhost: it must save a picture. Arguments: the README, the programs' folder."""
import json
import re
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

readme, programs = map(Path, sys.argv[1:])
client = re.search(r"```python\n(.*?)```", readme.read_text(), re.DOTALL)[1]
host = subprocess.Popen([programs / "sparkhost", "--config", "camera.lua", "--set", "web=false", "--set", "/sys/server/net/agents.port=0"],
                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
code = 1
with tempfile.TemporaryDirectory() as folder:
    try:
        port = json.loads(host.stdout.readline())["agentPort"]
        assert "3100" in client
        running = subprocess.Popen([sys.executable, "-c", client.replace("3100", str(port))], cwd=folder)
        for line in host.stderr:
            if "cameras have no pictures" in line:  # no OpenGL here
                running.kill()
                code = 77
            if code == 77 or "draws pictures" in line:
                break
        if code != 77 and running.wait() == 0:
            picture = Path(folder, "picture.png").read_bytes()
            size = struct.unpack(">II", picture[16:24])
            print(f"{len(picture)} bytes, {size[0]} x {size[1]} px")
            code = 0 if picture[:8] == b"\x89PNG\r\n\x1a\n" and size == (320, 240) else 1
    finally:
        host.terminate()
        host.communicate()
sys.exit(code)
