#!/usr/bin/env python3
"""Follows a page of docs/ word for word: writes its files, gives its commands, and compares what they say.

    follow.py PAGE BUILD        runs all of it; BUILD is the build tree that the page calls build/release
    follow.py --files PAGE DIR  only writes the files into a folder

What a fenced block is, its first line says:

    ```lua sumo.lua       a file, written into the working folder of the commands so far
    ```lua >>sumo.lua     text for the end of that file
    ```sh                 commands for bash, each of which must succeed; the next block goes on in their folder and environment
    ```text               what the commands before it say on stdout and stderr: these lines, in this order. ... is any text, or any lines.
    ```text like          the same, but numbers and hashes may be others
    ```text rising        the same as like, with any bars of # . o, and a last number in the last bar's line that is greater than the first's

Everything happens below a new folder, which is the commands' home. A block without such a first line is only read.
"""
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SOURCES = Path(__file__).resolve().parent.parent.parent
NUMBER = r"-?[0-9]+(?:\.[0-9]+)?"
SECONDS = 10800  # for a block of commands that hangs


def blocks(page):
    """(line, kind, name, text) of every fenced block."""
    kind = None
    for number, line in enumerate(page.read_text().split("\n"), 1):
        if kind is None and line.startswith("```"):
            kind, _, name = line[3:].partition(" ")
            begin, text = number, []
        elif line == "```" and kind is not None:
            yield begin, kind, name.strip(), "".join(t + "\n" for t in text)
            kind = None
        elif kind is not None:
            text.append(line)


def write(folder, name, text):
    file = folder / name.removeprefix(">>")
    file.parent.mkdir(parents=True, exist_ok=True)
    with open(file, "a" if name.startswith(">>") else "w") as out:
        out.write(text)


def pattern(line, how):
    """A regular expression for a line of a page: what may be otherwise is found first, all else is taken as it is."""
    loose = [(r"\.\.\.", ".*")]
    if how == "rising":
        loose.append((r"[#.o]{10,}", "[#.o]+"))
    if how in ("like", "rising"):
        loose += [(r"\b[0-9a-f]{16}\b", "[0-9a-f]{16}"), (NUMBER, NUMBER)]
    if how == "rising":
        loose.insert(0, loose.pop(1))  # bars hold dots
    parts = re.split("(" + "|".join(f"(?:{what})" for what, _ in loose) + ")", line)
    return "".join(next(by for what, by in loose if re.fullmatch(what, part)) if i % 2 else re.escape(part) for i, part in enumerate(parts))


def missing(wanted, said, how):
    """The first line of a page that was not said behind those before it; None when all were."""
    rest = iter(said.split("\n"))
    for line in wanted.rstrip("\n").split("\n"):
        if line.strip() != "..." and not any(re.search(pattern(line, how), found) for found in rest):
            return line
    return None


def is_rising(said):
    numbers = [float(re.findall(NUMBER, line)[-1]) for line in said.split("\n") if re.search(r"[#.o]{10,}", line)]
    return len(numbers) > 1 and numbers[-1] > numbers[0]


class Shell:
    """Commands of bash, one block after the other, in one environment and folder."""

    def __init__(self, home, build):
        self.home, self.build = home, build
        self.state = home / ".state"
        self.state.write_text(f"cd {SOURCES}\n")

    def folder(self):
        return Path(self.run("pwd"))

    def run(self, commands):
        commands = commands.replace("build/release", self.build)
        script = f". {self.state}\nset -eo pipefail\n{commands}\n{{ export -p; echo \"cd '$PWD'\"; }} >{self.state}\n"
        environment = {**os.environ, "HOME": str(self.home), "CXXFLAGS": "-Wall -Wextra -Werror", "CMAKE_BUILD_PARALLEL_LEVEL": "2"}
        environment.pop("PYTHONUNBUFFERED", None)  # a line in pieces would have others' lines between them
        shell = subprocess.Popen(["bash", "-c", script], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                 env=environment, start_new_session=True)
        try:
            said, _ = shell.communicate(timeout=SECONDS)
        except subprocess.TimeoutExpired:
            os.killpg(shell.pid, signal.SIGKILL)
            said, _ = shell.communicate()
            raise Failure(f"it took longer than {SECONDS} s, and said\n{said}") from None
        if shell.returncode:
            raise Failure(f"it ended with exit code {shell.returncode}, and said\n{said}")
        return said.rstrip("\n")


class Failure(Exception):
    pass


def follow(page, build, home):
    shell, said = Shell(home, build), None
    for line, kind, name, text in blocks(page):
        begun = time.monotonic()
        try:
            if kind == "text" and said is not None:
                lost = missing(text, said, name)
                if lost is not None:
                    raise Failure(f"the page promises\n{lost}\nand the commands said\n{said}")
                if name == "rising" and not is_rising(said):
                    raise Failure(f"the last bar is not the longest:\n{said}")
            elif kind == "sh":
                said = shell.run(text)
            elif name:
                folder = shell.folder()
                if folder.samefile(SOURCES):
                    raise Failure("a file would be written into Spark's own folder: the commands before it must go to another one")
                write(folder, name, text)
        except Failure as failure:
            print(f"{page}:{line}: {failure}", file=sys.stderr)
            return 1
        print(f"{page.name}:{line}: {kind} {name} {time.monotonic() - begun:.1f} s", flush=True)
        if kind == "sh":
            print(said, flush=True)
    if said is None:
        print(f"{page}: there are no commands", file=sys.stderr)
        return 1
    return 0


def main(arguments):
    if len(arguments) == 3 and arguments[0] == "--files":
        for _, kind, name, text in blocks(Path(arguments[1])):
            if name and kind not in ("sh", "text"):
                write(Path(arguments[2]), name, text)
        return 0
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    home = Path(tempfile.mkdtemp(prefix="spark-page-"))
    try:
        return follow(Path(arguments[0]), arguments[1], home)
    finally:
        shutil.rmtree(home, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
