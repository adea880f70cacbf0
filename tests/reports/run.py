#!/usr/bin/env python3
"""Runs the cases of public reports. usage: run.py [--bin FOLDER] [--row N]... [--json] [--jobs N] [NAME...]; see README.md."""
import argparse
import concurrent.futures
import json
import os
import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ENGINES = ["OdeEngine", "ArticulatedEngine", "BulletEngine", "MujocoEngine"]
PATIENCE = 1200  # s; a case that takes longer hangs


def row_of(text):
    """A row of the table of reports is a number, one of the papers a text: p66, pF8."""
    return int(text) if text.strip().isdigit() else text.strip()


class Case:
    """The first lines of a case's file."""

    def __init__(self, file):
        self.file, self.name = file, file.stem
        self.row, self.input, self.right, self.exit, self.slow = 0, "", "", 0, False
        self.engines, self.arguments, self.expected, self.never = [None], ["--duration", "2"], [], []
        self.unheard = []  # texts in `never` that no other case expects: nothing shows that they would be seen
        mark = "--" if file.suffix == ".lua" else "#"
        entries = []
        for line in file.read_text().splitlines():
            if not line.startswith(mark):
                break
            if found := re.match(re.escape(mark) + r" (\w+): (.*)", line):
                entries.append(list(found.groups()))
            elif entries and line.startswith(mark + "   "):  # goes on with the line before
                entries[-1][1] += " " + line[len(mark):].strip()
        for key, value in entries:
            self.take(key, value)
        if not (self.row and self.input and self.right):
            raise ValueError(f"{file}: expected the lines row, input and right at its start")

    def take(self, key, value):
        if key in ("input", "right"):
            setattr(self, key, value.strip())
        elif key == "row":
            self.row = row_of(value)
        elif key == "exit":
            self.exit = int(value)
        elif key == "slow":
            self.slow = True
        elif key == "engines":
            self.engines = ENGINES if value.strip() == "all" else value.split()
        elif key == "args":
            self.arguments = value.split()
        elif key == "expect":
            self.expected.append(value)
        elif key == "never":
            self.never.append(value)
        else:
            raise ValueError(f"{self.file}: expected row, input, right, engines, args, slow, expect, never or exit, found '{key}'")


def is_json(line):
    try:
        json.loads(line)
        return True
    except ValueError:
        return False


def command(case, engine, folder):
    choice = ["--set", f"engine={engine}"] if engine else []
    if case.file.suffix == ".py":
        return [sys.executable, case.file, *([engine] if engine else [])]
    return [folder / "sparkhost", "--config", case.file, "--scene-path", HERE / "models", "--rate", "max", *case.arguments, *choice]


def judge(case, code, out, log):
    """(what was seen, what is wrong)"""
    text = out + log
    lines = re.findall(r"\b(right|wrong): (.*)", text)
    seen = [what for _, what in lines] + [f"'{e}'" for e in case.expected if e in text]
    wrong = [what for verdict, what in lines if verdict == "wrong"]
    wrong += [f"'{e}' is not in the log" for e in case.expected if e not in text]
    wrong += [f"'{n}' is in the log" for n in case.never if n in text]
    wrong += [f"'{n}' is never said, but no other case expects it: is it spelt so?" for n in case.unheard]
    if code != case.exit:
        wrong.append(f"exit code {code}")
    if not seen:
        wrong.append("nothing was judged")
    if case.file.suffix == ".lua":
        wrong += [f"stdout has a line that is no JSON: {line[:60]}" for line in out.splitlines() if not is_json(line)][:1]
    return seen, wrong


def run(case, engine, folder):
    """One row of the result."""
    try:
        done = subprocess.run([str(c) for c in command(case, engine, folder)], capture_output=True, text=True, errors="replace",
                              timeout=PATIENCE, env={**os.environ, "SPARKBIN": str(folder)})
        code, out, log = done.returncode if done.returncode >= 0 else 128 - done.returncode, done.stdout, done.stderr
    except subprocess.TimeoutExpired:
        code, out, log = "none: it hangs", "", ""
    seen, wrong = judge(case, code, out, log)
    return {"row": case.row, "case": case.name, "engine": engine or "", "input": case.input, "right": case.right,
            "seen": "; ".join(wrong or seen), "good": not wrong, "log": log if wrong else ""}


def run_all(folder, rows=(), names=(), jobs=1, cases=HERE / "cases", slow=False):
    """The results of all cases of a folder with these rows and names, sorted by row."""
    cases = [Case(f) for f in sorted(Path(cases).iterdir()) if f.suffix in (".lua", ".py")]
    for case in cases:
        others = [text for c in cases if c is not case for text in c.expected]
        case.unheard = [n for n in case.never if not any(n in text for text in others)]
    cases = [c for c in cases if (not rows or c.row in rows) and (not names or c.name in names) and (slow or names or not c.slow)]
    work = sorted(((c, e) for c in cases for e in c.engines), key=lambda w: (str(w[0].row).zfill(4), w[0].name))
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        yield from pool.map(lambda w: run(w[0], w[1], Path(folder)), work)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", default=HERE.parent.parent / "build/release/bin")
    parser.add_argument("--cases", default=HERE / "cases", help="folder of the cases")
    parser.add_argument("--row", type=row_of, action="append", default=[])
    parser.add_argument("--all", action="store_true", help="the slow ones, too")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--log", action="store_true", help="print the log of what is wrong")
    parser.add_argument("names", nargs="*")
    options = parser.parse_args()
    count = bad = 0
    for r in run_all(Path(options.bin).resolve(), options.row, options.names, options.jobs, options.cases, options.all):
        count, bad = count + 1, bad + (not r["good"])
        print(f"{'right' if r['good'] else 'WRONG'} | {r['row']:>2} | {r['case']} {r['engine']} | {r['input']} | {r['right']} | {r['seen']}", flush=True)
        if options.log and r["log"]:
            print(r["log"][-4000:])
    print(f"{count} cases, {bad} wrong")
    return 1 if bad or not count else 0


if __name__ == "__main__":
    sys.exit(main())
