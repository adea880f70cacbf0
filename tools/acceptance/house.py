"""The milestone `house`: a small kernel, floors with arrows downwards, plain words, and what keeps them so."""
import re
import subprocess

from acceptance.common import FAIL, PASS, ROOT, run, say, tests

KERNEL_LINES = 3500
CHECK_MINUTES = 40
# Floors, lowest first, with those whose headers each may include.
FLOORS = {
    "core/base": [],
    "core/message": ["core/base"],
    "core/kernel": ["core/base"],
    "core/script": ["core/base", "core/message", "core/kernel"],
}


def sources(folder):
    return [p for p in sorted((ROOT / folder).rglob("*")) if p.suffix in (".h", ".cpp") and "tests" not in p.parts]


def code_lines(folder):
    """Lines that are neither empty nor a comment, and all lines."""
    lines = [line for p in sources(folder) for line in p.read_text().splitlines()]
    return sum(not re.match(r"\s*(//|$)", line) for line in lines), len(lines)


def arrows():
    """Includes of core's headers against the floors."""
    owners = {p.relative_to(ROOT / floor / "include").as_posix(): floor for floor in FLOORS for p in (ROOT / floor / "include").rglob("*.h")}
    wrong = []
    for floor, below in FLOORS.items():
        for path in sources(floor):
            for name in re.findall(r'#include "(.*?)"', path.read_text()):
                owner = owners.get(name)
                if (owner and owner != floor and owner not in below) or name.startswith("api/"):
                    wrong.append(f"{path.relative_to(ROOT)} includes {name}")
    return wrong


def shape():
    code, lines = code_lines("core/kernel")
    words = subprocess.run([ROOT / "tools/lint-words"], capture_output=True, text=True)
    wrong = arrows()
    page = (ROOT / "docs/architecture.md").exists()
    good = code <= KERNEL_LINES and words.returncode == 0 and not wrong and page
    return (f"core/kernel: {code} lines of code (at most {KERNEL_LINES}; {lines} with comments); tools/lint-words: exit {words.returncode}; "
            f"includes against the floors: {len(wrong)}{' ' + wrong[0] if wrong else ''}; docs/architecture.md {'is there' if page else 'is missing'}"), PASS if good else FAIL


def behaviour():
    sessions, repeated = tests("conformance-.*")
    hashes, same = tests("golden", "bench-hashes")
    say("tools/accept fast")
    fast = run([ROOT / "tools/accept", "fast"]).returncode == 0
    return f"sessions: {sessions}; hashes: {hashes}; fast {'pass' if fast else 'FAIL'}", PASS if repeated == same == PASS and fast else FAIL


def kept():
    """What tools/check does, and how long it took the last time."""
    measured, verdict = tests("page-.*", "golden", "lua", "core-text", "monitor.*")
    stages = ROOT / "build/check/stages"
    lines = stages.read_text().splitlines() if stages.exists() else []
    present = all(any(line.startswith(stage + " ") for line in lines) for stage in ("format", "words", "lint"))
    seconds = int(re.match(r"sum\s+(\d+) s", lines[-1]).group(1)) if present and lines[-1].startswith("sum") else None
    presets = (ROOT / "CMakePresets.json").read_text()
    strict = presets.count('"testPresets"') == 1 and presets.count('"noTestsAction": "error"') == presets.count('"outputOnFailure"')
    good = verdict == PASS and seconds is not None and seconds <= CHECK_MINUTES * 60 and strict
    return (f"{measured}; last tools/check: {'format, words and lint among its stages, ' + ' '.join(lines[-1].split()) if seconds else 'not on record'} "
            f"(at most {CHECK_MINUTES} min); ctest presets {'fail' if strict else 'pass'} when no test runs"), PASS if good else FAIL


POINTS = {
    "1": ("one page; a kernel of at most 3,500 lines; soccer's words at home; arrows downwards", shape),
    "2": ("nothing behaves differently", behaviour),
    "3": ("tutorial, traps, format and lint are part of tools/check", kept),
}
