"""Programs that a case starts, and what it says of them."""
import json
import os
import re
import subprocess
import sys
import tempfile
import threading


def judge(good, what):
    print(f"{'right' if good else 'wrong'}: {what}", flush=True)


class Program:
    """A program of this build; its stderr is collected. Killed at the end of a `with`."""

    def __init__(self, name, *arguments, limit=None, **options):
        command = [os.environ["SPARKBIN"] + "/" + name, *map(str, arguments)]
        if limit:  # bytes of address space
            command = ["/bin/sh", "-c", f'ulimit -v {limit >> 10}; exec "$0" "$@"', *command]
        self.process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace", **options
        )
        self.log = []
        self.changed = threading.Condition()
        self.reader = threading.Thread(target=self.collect, daemon=True)
        self.reader.start()

    def collect(self):
        for line in self.process.stderr:
            with self.changed:
                self.log.append(line)
                self.changed.notify_all()
        with self.changed:
            self.log.append("")
            self.changed.notify_all()

    def first_line(self):
        """The JSON of its first line."""
        line = self.process.stdout.readline()
        if not line:
            self.process.wait()
            self.reader.join()
            judge(False, "the program ended: " + self.text())
            sys.exit(1)
        return json.loads(line)

    def last_line(self):
        """The JSON of its last line, once it has ended."""
        lines = self.process.stdout.read().splitlines()
        self.process.wait()
        self.reader.join()
        return json.loads(lines[-1]) if lines else None

    def text(self):
        with self.changed:
            return "".join(self.log)

    def wait_for(self, pattern):
        """The first match in its log; None if it ended without one."""
        with self.changed:
            while not (found := re.search(pattern, "".join(self.log))):
                if self.log and not self.log[-1]:
                    return None
                self.changed.wait()
            return found

    def memory(self):
        """Its largest resident size so far [MB]."""
        with open(f"/proc/{self.process.pid}/status") as file:
            return int(re.search(r"VmHWM:\s+(\d+)", file.read())[1]) // 1024

    def end(self):
        self.process.terminate()
        return self.process.wait()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()


def host(*arguments, config=None, **options):
    """A host that prints what it listens at."""
    if config:
        folder = tempfile.mkdtemp()
        with open(folder + "/config.lua", "w") as file:
            file.write(config)
        arguments = ("--config", folder + "/config.lua", *arguments)
    return Program("sparkhost", *arguments, **options)
