#!/usr/bin/env python3
# row: 23
# input: older copies of a plugin beside it, and newer files of a plugin that is loaded
# right: the file with the name wins; load takes newer code, or says why the code of before runs on
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import *  # noqa: E402,F403

import os
import shutil

with Folder() as folder:
    plugins = folder / "plugins"
    plugins.mkdir()
    source = next(
        (
            BIN / place / "sounds.so"
            for place in ("../plugins", "../lib/spark/plugins", "../lib/x86_64-linux-gnu/spark/plugins")
            if (BIN / place / "sounds.so").exists()
        )
    )

    def put(name):
        """A file with other times, in the place of what is there."""
        shutil.copy(source, plugins / (name + ".new"))
        os.replace(plugins / (name + ".new"), plugins / name)

    for name in ("sounds-old.so", "a-sounds.so", "sounds.so", "sounds (copy).so", "zsounds.so"):
        put(name)
    listed = run("sparkhost", "--list-plugins", "--plugin-path", plugins)
    running = Live(
        "--config", "world.lua", "--set", "/sys/server/simulation.rate=real", "--plugin-path", plugins, cwd=folder
    )
    done = running.ctl("load", "sounds")
    judge(
        "of five files the one with the plugin's name is loaded",
        done.returncode == 0 and f"from {plugins}/sounds.so" in done.stdout,
        done.stdout + done.stderr,
    )
    judge(
        "each other one is named",
        all(
            f"refused plugin {plugins}/{other}" in listed.stderr
            for other in ("sounds-old.so", "a-sounds.so", "sounds (copy).so", "zsounds.so")
        ),
        listed.stderr,
    )
    put("sounds.so")
    done = running.ctl("load", "sounds")
    judge("newer code is loaded while there are no objects", done.returncode == 0, done.stderr)
    done = running.ctl("load", "sounds")
    judge("code that is the newest is left alone", done.returncode == 0, done.stderr)
    (plugins / "sounds.so").write_bytes(source.read_bytes()[:20000])
    done = running.ctl("load", "sounds")
    judge("half a file is refused, with its name", done.returncode == 1 and "sounds.so" in done.stderr, done.stderr)
    put("sounds.so")
    done = running.ctl("load", "sounds")
    judge("the whole one is taken", done.returncode == 0, done.stderr)
    running.stop()

    (folder / "uses.lua").write_text(
        WORLD + 'monitors{ port = 0 }\nplugin "sounds"\nnew("Sounds", "/sys/server/monitor/sounds")\n'
    )
    running = Live("--config", "uses.lua", "--plugin-path", plugins, cwd=folder)
    put("sounds.so")
    done = running.ctl("load", "sounds")
    judge(
        "while objects live the code of before runs on, and load says so, with the objects",
        done.returncode == 1 and "code of before" in done.stderr and "/sys/server/monitor/sounds" in done.stderr,
        done.stdout + done.stderr,
    )
    running.stop()
