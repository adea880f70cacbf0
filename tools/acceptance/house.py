"""The milestone `house`: a small kernel, floors with arrows downwards, plain words, and what keeps them so."""
import re
import subprocess

from acceptance.common import FAIL, OPEN, PASS, ROOT, last_check, run, say, tests

KERNEL_LINES = 3500
# The libraries ("floors") of core, lowest first, each with the ones whose headers it may include.
FLOORS = {
    "core/base": [],
    "core/message": ["core/base"],
    "core/kernel": ["core/base"],
    "core/script": ["core/base", "core/message", "core/kernel"],
}


def sources(folder):
    return [p for p in sorted((ROOT / folder).rglob("*")) if p.suffix in (".h", ".cpp") and "tests" not in p.parts]


def code_lines(folder):
    """Number of lines that are neither empty nor comments, and of all lines."""
    lines = [line for p in sources(folder) for line in p.read_text().splitlines()]
    return sum(not re.match(r"\s*(//|$)", line) for line in lines), len(lines)


def arrows():
    """Checks that core's headers include only headers of permitted floors."""
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
    fast = run([ROOT / "tools/accept", "fast"])
    failed = [" ".join(line.split()) for line in fast.stdout.splitlines() if "| fail" in line.lower()]
    return f"sessions: {sessions}; hashes: {hashes}; fast: {'; '.join(failed) or f'exit code {fast.returncode}'}", PASS if repeated == same == PASS and fast.returncode == 0 else FAIL


def kept():
    """What tools/check does."""
    measured, verdict = tests("page-.*", "golden", "lua", "core-text", "monitor.*")
    found = last_check("all", "long")
    present = bool(found) and all(any(line.startswith(stage + " ") for line in found[2]) for stage in ("format", "words", "lint"))
    presets = (ROOT / "CMakePresets.json").read_text()
    strict = presets.count('"testPresets"') == 1 and presets.count('"noTestsAction": "error"') == presets.count('"outputOnFailure"')
    checked = f"format, words and lint among its stages, {found[1]}" if present else "lacks format, words or lint" if found else "not on record"
    return (f"{measured}; last tools/check --all: {checked}; ctest presets {'fail' if strict else 'pass'} when no test runs",
            FAIL if verdict != PASS or not strict or (found and not (present and ", 0 failed" in found[1])) else PASS if found else OPEN)


POINTS = {
    "1": ("one page; a kernel of at most 3,500 lines; soccer's words at home; arrows downwards", shape),
    "2": ("nothing behaves differently", behaviour),
    "3": ("tutorial, traps, format and lint are part of tools/check --all", kept),
}
