"""What is changed of the product: its files by folder, and the order in which their mutants are drawn."""
import hashlib
import subprocess
from pathlib import Path

from mutation.operators import REVIEWER, mutants_of

ROOT = Path(__file__).resolve().parent.parent.parent
VIEWER = "plugins/monitor-web/viewer"
# What the public headers say is compiled into everything: a change there builds the world, and plugins of before are refused. They are
# changed where they are named.
PUBLIC = ("core/base/include/", "core/kernel/include/", "core/message/include/", "core/script/include/", "plugins/api/", "tools/client/include/")
SMALL = 200  # lines: folders below are one in the draw and in the table
TOGETHER = "small folders"


def is_source(file):
    parts = file.split("/")
    if "tests" in parts or file.startswith(PUBLIC):
        return False
    if file.endswith(".ts"):
        return file.startswith(f"{VIEWER}/src/")
    return file.endswith((".cpp", ".h")) and parts[0] in ("core", "plugins", "tools") or file.endswith(".lua") and parts[0] == "lua"


def folder_of(file):
    """The folder by which a file counts."""
    return VIEWER if file.startswith(VIEWER + "/") else "lua" if file.startswith("lua/") else "/".join(file.split("/")[:2])


def all_files(root=ROOT):
    listed = subprocess.run(["git", "ls-files", "-coz", "--exclude-standard"], cwd=root, stdout=subprocess.PIPE, text=True, check=True).stdout
    return sorted(f for f in listed.split("\0") if f and (Path(root) / f).is_file())


def sources(paths, root=ROOT):
    """The files of the product, or those at `paths`, which may be public headers."""
    files = all_files(root)
    if not paths:
        return [f for f in files if is_source(f)]
    paths = [str(p).rstrip("/") for p in paths]
    if strange := [p for p in paths if not any(f == p or f.startswith(p + "/") for f in files)]:
        raise SystemExit(f"tools/mutate: there is no {', '.join(strange)} in the tree")
    return [f for f in files if f in paths or is_source(f) and any(f.startswith(p + "/") for p in paths)]


def folders(files, root=ROOT):
    """{folder as in the table: its files}"""
    out, lines = {}, {}
    for file in files:
        folder = folder_of(file)
        out.setdefault(folder, []).append(file)
        lines[folder] = lines.get(folder, 0) + (Path(root) / file).read_text().count("\n")
    small = [f for f in out if lines[f] < SMALL]
    if len(small) > 1:
        out[TOGETHER] = sorted(file for folder in small for file in out.pop(folder))
    return dict(sorted(out.items()))


def drawn(files, seed, root=ROOT):
    """The mutants of the files in the order in which they are drawn: one of a reviewer, one of a compiler, and so on. A reviewer's operators take
    turns. A line gives at most one mutant to each of both, and its place depends on the line alone, so that a change elsewhere does not draw
    others."""
    rank = lambda *words: hashlib.sha256("\0".join([str(seed), *words]).encode()).digest()
    kinds = {True: {}, False: {}}  # {is a reviewer's: {operator: [(rank, mutant)]}}
    for file in sorted(files):
        for identity, choices in mutants_of(file, (Path(root) / file).read_text()):
            for reviewer in (True, False):
                if some := [m for m in choices if (m.operator in REVIEWER) == reviewer]:
                    m = min(some, key=lambda m: rank("change", identity, m.after))
                    kinds[reviewer].setdefault(m.operator if reviewer else "", []).append((rank("line", identity), m))
    order = {}
    for reviewer, operators in kinds.items():
        turns = [(i, rank("turn", operator, folder_of(m.file)), m)
                 for operator, found in operators.items() for i, (_, m) in enumerate(sorted(found, key=lambda e: e[0]))]
        order[reviewer] = [m for _, _, m in sorted(turns, key=lambda e: e[:2])]
    out, lines = [], set()
    for i in range(max(map(len, order.values()))):
        for m in order[True][i:i + 1] + order[False][i:i + 1]:
            if (m.file, m.line) not in lines:
                out.append(m)
                lines.add((m.file, m.line))
    return out


def shares(sizes, count, least=3):
    """{folder: how many of `count` mutants are of it}: `least`, and the rest by the number of its mutants."""
    out = {folder: min(least, size) for folder, size in sizes.items()}
    while sum(out.values()) < count and any(out[f] < sizes[f] for f in sizes):
        out[max((f for f in sizes if out[f] < sizes[f]), key=lambda f: (sizes[f] / (out[f] + 1 - least + 1), f))] += 1
    return out
