#!/usr/bin/env python3
"""Follows a page word for word: writes its files, gives its commands, and compares what they print.

    follow.py PAGE BUILD        runs all of it; BUILD is the build tree that the page calls build/release
    follow.py --files PAGE DIR  only writes the files into a folder
    follow.py --skipped PAGE    prints the commands that are not followed, with the reasons

The first line of a fenced block gives its kind:

    ```lua sumo.lua       a file, written into the working folder of the commands so far
    ```lua >>sumo.lua     text for the end of that file
    ```sh                 commands for bash, each of which must succeed; the next block goes on in their folder and environment
    ```sh until Ctrl-C    commands that run until they are interrupted: after their first line on stdout they are
    ```sh skip: REASON    commands that are not followed
    ```text               what the commands before it print on stdout and stderr: these lines, in this order. ... is any text, or any lines.
    ```text like          the same, but numbers and hashes may differ
    ```text rising        the same as like, with any bars of # . o, and a last number in the last bar's line that is greater than the first's

Commands start in the checkout, with a new folder as home. Where the kernel allows it, they have a network of their own,
so that fixed ports are free. Programs that a block leaves in the background run until the page ends. A block without
such a first line is only read.
"""
import fcntl
import os
import re
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SOURCES = Path(__file__).resolve().parent.parent.parent
NUMBER = r"-?[0-9]+(?:\.[0-9]+)?"
SECONDS = 2400  # for a block of commands that hangs
SKIP = "skip:"
UNTIL_STOPPED = "until Ctrl-C"


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
    """A regular expression for a line of a page: variable parts become patterns, all other text is literal."""
    loose = [(r"\.\.\.", ".*")]
    if how == "rising":
        loose.append((r"[#.o]{10,}", "[#.o]+"))
    if how in ("like", "rising"):
        loose += [(r"\b[0-9a-f]{16}\b", "[0-9a-f]{16}"), (NUMBER, NUMBER)]
    if how == "rising":
        loose.insert(0, loose.pop(1))  # bars contain dots
    parts = re.split("(" + "|".join(f"(?:{what})" for what, _ in loose) + ")", line)
    return "".join(next(by for what, by in loose if re.fullmatch(what, part)) if i % 2 else re.escape(part) for i, part in enumerate(parts))


def missing(wanted, said, how):
    """The first line of a page that the output lacks after the lines before it; None if all were found."""
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
        self.home, self.build, self.shells, self.blocks = home, build, [], 0
        self.own = home / ".own"  # sparkctl looks for sockets of hosts in both folders: it must find this page's alone
        self.own.mkdir(mode=0o700)
        self.state = home / ".state"
        self.state.write_text(f"cd {SOURCES}\n")

    def folder(self):
        return Path(self.run("pwd"))

    def start(self, commands, out, errors=subprocess.STDOUT):
        """bash with these commands, which leave their folder and environment to the next block."""
        commands = re.sub(r"(\$PWD/)?build/release", lambda _: self.build, commands)
        script = f". {self.state}\nset -eo pipefail\n{commands}\n{{ export -p; echo \"cd '$PWD'\"; }} >{self.state}\n"
        environment = {**os.environ, "HOME": str(self.home), "XDG_RUNTIME_DIR": str(self.own), "TMPDIR": str(self.own),
                       "CXXFLAGS": "-Wall -Wextra -Werror", "CMAKE_BUILD_PARALLEL_LEVEL": "2"}
        environment.pop("PYTHONUNBUFFERED", None)  # a line in pieces would have others' lines between them
        shell = subprocess.Popen(["bash", "-c", script], stdin=subprocess.DEVNULL, stdout=out, stderr=errors, env=environment, start_new_session=True)
        self.shells.append(shell)
        return shell

    def output(self):
        """A file for what a block prints. A pipe would stay open as long as programs in the background."""
        self.blocks += 1
        return open(self.home / f".output-{self.blocks}", "w+")

    def run(self, commands):
        with self.output() as said:
            return ended(self.start(commands, said), said)

    def run_until_stopped(self, commands):
        """Commands that print a line on stdout when they are ready, and end after SIGINT."""
        with self.output() as said:
            shell = self.start(f"exec {commands.strip()}", subprocess.PIPE, said)
            ready = shell.stdout.readline()
            if not ready:
                raise Failure(f"it ended by itself with exit code {shell.wait()}, and printed\n{text(said)}")
            shell.send_signal(signal.SIGINT)
            rest = shell.stdout.read()
            return (ready + rest).decode() + ended(shell, said, " after Ctrl-C")

    def close(self):
        """Ends what is left in the background."""
        for shell in self.shells:
            try:
                os.killpg(shell.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            shell.wait()


def ended(shell, said, when=""):
    """What commands printed that have ended well."""
    try:
        shell.wait(timeout=SECONDS)
    except subprocess.TimeoutExpired:
        raise Failure(f"it took longer than {SECONDS} s{when}, and printed\n{text(said)}") from None
    if shell.returncode:
        raise Failure(f"it ended with exit code {shell.returncode}{when}, and printed\n{text(said)}")
    return text(said)


def text(file):
    """What a file holds, without line ends at its end."""
    file.seek(0)
    return file.read().rstrip("\n")


class Failure(Exception):
    pass


def follow(page, build, home):
    shell = Shell(home, build)
    try:
        return follow_with(shell, page)
    finally:
        shell.close()


def follow_with(shell, page):
    said = None
    for line, kind, name, text in blocks(page):
        begun = time.monotonic()
        try:
            if kind == "text" and said is not None:
                lost = missing(text, said, name)
                if lost is not None:
                    raise Failure(f"the page promises\n{lost}\nand the commands printed\n{said}")
                if name == "rising" and not is_rising(said):
                    raise Failure(f"the last bar is not the longest:\n{said}")
            elif kind == "sh" and name.startswith(SKIP):
                print(f"{page.name}:{line}: not followed: {name.removeprefix(SKIP).strip()}")
                continue
            elif kind == "sh":
                said = shell.run_until_stopped(text) if name == UNTIL_STOPPED else shell.run(text)
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


def own_network():
    """Goes on in a network of its own with ports that are all free, or in this one where the kernel refuses it."""
    if os.environ.get("SPARK_OWN_NETWORK") or not shutil.which("unshare"):
        return
    alone = ["unshare", "--net"] if os.getuid() == 0 else ["unshare", "--user", "--map-root-user", "--net"]
    if subprocess.run([*alone, "true"], stderr=subprocess.DEVNULL).returncode == 0:
        os.execvpe(alone[0], [*alone, sys.executable, *sys.argv], {**os.environ, "SPARK_OWN_NETWORK": "yes"})


def raise_loopback():
    """Switches the interface lo on (SIOCSIFFLAGS, IFF_UP; netdevice(7))."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        fcntl.ioctl(any_socket, 0x8914, struct.pack("16sh14x", b"lo", 1))


def main(arguments):
    if len(arguments) == 3 and arguments[0] == "--files":
        for _, kind, name, text in blocks(Path(arguments[1])):
            if name and kind not in ("sh", "text"):
                write(Path(arguments[2]), name, text)
        return 0
    if len(arguments) == 2 and arguments[0] == "--skipped":
        page = Path(arguments[1])
        for line, kind, name, text in blocks(page):
            if kind == "sh" and name.startswith(SKIP):
                print(f"{page.name}:{line}: {name.removeprefix(SKIP).strip()}: {'; '.join(text.splitlines())}")
        return 0
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    own_network()
    if os.environ.get("SPARK_OWN_NETWORK"):
        raise_loopback()
    home = Path(tempfile.mkdtemp(prefix="spark-page-"))
    try:
        return follow(Path(arguments[0]), os.path.abspath(arguments[1]), home)
    finally:
        shutil.rmtree(home, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
