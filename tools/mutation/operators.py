"""What is changed: one statement at a time, as a compiler's mutants (`<` to `<=`, a call removed) and as a reviewer's: a check of input removed,
a field left out of the state, a log line swallowed, another order, one cycle late, the wrong frame or unit, a limit off by one, a right that
is not asked for, a resource that is not released."""
import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Mutant:
    file: str  # below the root of the tree
    line: int  # its first, from 1
    before: str  # one or more whole lines, or in tools/mutate.named a part of the file that is there once
    after: str
    operator: str = "by hand"

    def text(self):
        words = lambda text: " ".join(text.split()) or "(nothing)"
        return f"{self.file}:{self.line}: {words(self.before)} -> {words(self.after)} [{self.operator}]"


# The operators of a reviewer; all others are those of a compiler.
CHECK, STATE, LOG, ORDER, LATE, FRAME, UNIT, LIMIT, RIGHT, RESOURCE = REVIEWER = (
    "check of input removed", "field left out of the state", "log line swallowed", "another order", "one cycle late", "wrong frame", "wrong unit",
    "limit off by one", "right not asked for", "resource not released")


@dataclass(frozen=True)
class Language:
    comment: str  # a regular expression of comments, and of strings that are not in quotes
    no_code: re.Pattern  # lines that are not changed
    swaps: tuple
    condition: re.Pattern  # ends before the condition
    call: re.Pattern  # a line that is a call alone
    nothing: str  # what stands for a removed statement
    empty: str  # what stands for a result
    function: re.Pattern  # head of a function without a result
    end: str = ";"  # of a statement


COMMON = ((" < ", " <= "), (" <= ", " < "), (" > ", " >= "), (" >= ", " > "), (" + ", " - "), (" - ", " + "), (" * ", " / "), (" / ", " * "))
CURLY = (*COMMON, (" += ", " -= "), (" -= ", " += "), (" *= ", " /= "), (" && ", " || "), (" || ", " && "), ("++", "--"))
CALL = r"^\s*(?!return\b|throw\b|if\b|for\b|while\b|switch\b|delete\b|else\b|catch\b|super\b|function\b|local\b)[A-Za-z_][\w.:\->\[\]()]*\(.*\)"
NO_CODE = r"^\s*(#|//|\*|using |namespace |template|static_assert|SPARK_|case .*:$|public:|private:|protected:|$)|\bprefetch|\breserve\(|\boperator\b"

CPP = Language(r"//.*|/\*.*?\*/", re.compile(NO_CODE),
               (*CURLY, (" == ", " != "), (" != ", " == "), ("std::min(", "std::max("), ("std::max(", "std::min(")),
               re.compile(r"\b(?:if|while) (?=\()"), re.compile(CALL + r";\s*$"), ";", "{}",
               re.compile(r"^\s*(?:static |inline )*void [^;]*\) ?(?:const ?)?(?:noexcept ?)?(?:override ?)?\{$"))
TYPESCRIPT = Language(r"//.*|/\*.*?\*/|`[^`]*`", re.compile(NO_CODE + r"|^\s*(import|export type|type|interface) |^\s*(readonly )?\w+\??: [^=]*;$"),
                      (*CURLY, (" === ", " !== "), (" !== ", " === "), ("Math.min(", "Math.max("), ("Math.max(", "Math.min(")),
                      re.compile(r"\b(?:if|while) (?=\()"), re.compile(CALL + r";\s*$"), ";", "undefined as never",
                      re.compile(r"^\s*(?!set\b).*\): void \{$"))
LUA = Language(r"--.*|\[\[.*?\]\]", re.compile(r"^\s*(--|$)"),
               (*COMMON, (" == ", " ~= "), (" ~= ", " == "), (" and ", " or "), (" or ", " and "), ("math.min(", "math.max("), ("math.max(", "math.min(")),
               re.compile(r"\b(?:if|while) "), re.compile(CALL + r"\s*$"), "", "nil", re.compile(r"^(?!)"), "")


def language_of(file):
    return {".lua": LUA, ".ts": TYPESCRIPT}.get(file[file.rfind("."):], CPP)


def code_of(line, language=CPP):
    """The line with strings, characters and comments blanked, at the same columns."""
    blank = lambda m: m[0][0] + " " * (len(m[0]) - 2) + m[0][-1] if m[0][0] in "\"'" else " " * len(m[0])
    character = r"(?<!\w)'(?:\\.|[^'\\])+'"
    return re.sub(r'"(?:\\.|[^"\\])*"|' + character + "|" + language.comment, blank, line, flags=re.S)


def closing(code, at):
    """Index of the parenthesis that closes the one at `at`, or -1."""
    depth = 0
    for i in range(at, len(code)):
        depth += (code[i] == "(") - (code[i] == ")")
        if depth == 0:
            return i
    return -1


def condition_of(code, language, at=0):
    """(start, end) of the next condition's text, or None. In C++ and TypeScript with its parentheses."""
    if not (m := language.condition.search(code, at)):
        return None
    if language is not LUA:
        end = closing(code, m.end())
        return (m.end(), end + 1) if end > 0 else None
    end = re.search(r" (then|do)\b", code[m.end():])
    return (m.end(), m.end() + end.start()) if end else None


# ---- a compiler's ----

def of_compiler(line, language=CPP):
    """[(operator, the changed line)]"""
    code = code_of(line, language)
    if language.no_code.search(code) or language.no_code.search(line):
        return []
    out = []
    put = lambda operator, start, end, text: out.append((operator, line[:start] + text + line[end:]))
    timed, limited = TIME.search(code), LIMITS.search(code)
    for old, new in language.swaps:
        if old in ("++", " < ", " > ") and "for (" in code or ('"' in code or "`" in line) and old in (" + ", " += "):
            continue  # endless, or one beyond the end, where what is found is chance; texts have no minus
        if language is LUA and old in (" and ", " or ") and re.match(r"^\s*for ", code):
            continue
        name = "operator swapped"
        if old in (" <= ", " >= ", " < ", " > "):
            name = LATE if timed and old in (" <= ", " >= ") else LIMIT if limited else name
        for m in re.finditer(re.escape(old), code):
            put(name, m.start(), m.end(), new)
    for m in re.finditer(r"(?<![\w.'])(\d+)(\.\d+)?(?![\w.'])", code):
        put("constant changed", m.start(), m.end(), str(int(m[1]) + 1) + (m[2] or ""))
    for m in re.finditer(r"\b(true|false)\b", code):
        put("constant changed", m.start(), m.end(), "false" if m[0] == "true" else "true")
    at = 0
    while found := condition_of(code, language, at):
        start, end = found
        if not re.search(r"\b(const|auto)\b|[;]| = ", code[start:end]):
            put("condition negated", start, end, f"not ({line[start:end]})" if language is LUA else f"(!{line[start:end]})")
        at = end
    indent = line[:len(line) - len(line.lstrip())]
    if language.call.match(code):
        name = RESOURCE if RELEASES.match(code) else CHECK if CHECKS.match(code) else LOG if LOGS.match(code) else "call removed"
        out.append((name, indent + language.nothing))
    if language.function.match(code):
        out.append(("early return", f"{line} return;"))
    if m := re.match(rf"^\s*return ([^;]+){language.end}\s*$", code):
        if m[1].strip() not in ("{}", "0", "false", "true", "nullptr", "*this", "nil", "null", "this") and not m[1].startswith(("{", "[")):
            out.append(("empty result", f"{indent}return {language.empty}{language.end}"))
    return out


# ---- a reviewer's ----

TIME = re.compile(r"\b(now|\w*[tT]imes?|\w*[dD]ue|\w*[dD]eadline|\w*[uU]ntil|\w*[cC]ycles?|\w*Since|\w*At)_?\b(?!\()")
LIMITS = re.compile(r"(?<!std::)\b(\w*([lL]imit|[mM]ost|[lL]east|[mM]aximum|[cC]apacity|[mM]ax|[lL]ongest|[lL]argest)\w*|kM\w+|kL\w+|size\(\)|length|count)")
RELEASES = re.compile(r"^\s*(?:\w+(?:\[\w+\])?(?:\(\))?(?:\.|->|::))*(close|erase|reset|release|unlock|stop|remove(?!_)\w*|shutdown|cancel\w*|disconnect|detach|unlink\w*|clear\w*|free|unload|destroy|"
                      r"kill|join|dispose|delete|terminate|revokeObjectURL|unmap|munmap)\(")
CHECKS = re.compile(r"^\s*(?:\w+(?:\.|->|::))*(expect|require|check|verify|refuse|ensure|validate|must)[A-Z]?\w*\(")
LOGS = re.compile(r"^\s*(?:\w+(?:\(\))?(?:\.|->|::))*(log[A-Z]?\w*|warn\w*|error|info|debug|inform|print|notice|report\w*\(.*\")(?:\(|(?<=\"))")
REFUSALS = re.compile(r"^(throw |error\(|fail\(|return (\"|fmt::format|std::string|.*([eE]rror|[fF]ail|[rR]efus|[wW]rong|[pP]roblem|[iI]nvalid)))")
RIGHTS = re.compile(r"\b(may[A-Z]\w*|\w*[pP]ermitted|allowed|isAllowed|\w*[aA]uthori[sz]\w*|(?:token_?|\w+Token_?)\b(?![.(])|\w*[rR]eferee_?\b(?!\(\)\.)|\w*[sS]pectator\w*|"
                    r"isOwner\w*|\w*[sS]ecret\w*|\w*[lL]oopback\w*|rights?_?|readOnly\w*|trusted\w*)\b")
TURNS = re.compile(r"\.(inverse|conjugate|transpose|transposed|invert|conjugated)\(\)")
UNITS = re.compile(r"\b(?:\w+(?:::|\.))*(?:toDegrees|toRadians|degrees|radians|degToRad|radToDeg|normalizeDeg|gDegToRad|gRadToDeg|rad|deg)(?=\()")
FACTORS = re.compile(r" [*/] (?:\w+::)?(?:kDegrees?|kRadians?|kDegToRad|kRadToDeg|kDegree\w*|kRadian\w*|kPi / 180|180 / kPi|M_PI / 180|180 / M_PI|1000(?:\.0)?|1e3|1e-3|1e6|1e-6|1e9|1e-9)(?![\w.])")
FRAMES = [("world", "local"), ("World", "Local"), ("global", "local"), ("Global", "Local")]
LOOP = re.compile(r"^\s*for \((?:const )?(?:auto|[\w:<>]+)[&* ]* ?(?:\w+|\[[\w, ]+\]) ?: (?!\{)")
LOOP_OF = re.compile(r"^\s*for \(const (?:\w+|\[[\w, ]+\]) of ")
COUNT = re.compile(r"^(\s*)for \((\w[\w:]*) (\w+) = 0; \3 < ([^;&|]+); \+\+\3\)(.*)$")
ORDERED = re.compile(r"\b(return|break|push_back|push|emplace_back|append|insert|write|send|add|make)\b")
STEPS = re.compile(r"\bvoid (?:\w+::)*(step|cycle|update|act|sense|begin|end|advance|apply|prePhysics|postPhysics|beginCycle|endCycle|stepAll|tick|spend)\w*\(")
STATEFUL = re.compile(r"\b(fields|saveState|loadState|save|restore)\(.*\{\s*$")


def statement_at(lines, first, language):
    """(text, number of lines) of the statement that begins with lines[first], up to eight lines, or None."""
    text, depth = "", 0
    for count in range(1, 9):
        if first + count > len(lines):
            return None
        text = "\n".join(lines[first:first + count])
        code = code_of(text, language).rstrip()
        depth = sum((c in "([{") - (c in ")]}") for c in code)
        if depth == 0 and code.endswith((";", "end", ")") if language is LUA else ";"):
            return text, count
        if depth != 0 and code.endswith(("{", "then")):
            return None
    return None


def ordered(lines, at, language):
    """Whether the order of the loop that begins there can be seen: it puts its elements into a list, or ends at one."""
    body, indent = [lines[at]], len(lines[at]) - len(lines[at].lstrip())
    for line in lines[at + 1:at + 6]:
        if len(line) - len(line.lstrip()) <= indent or lines[at].rstrip().endswith(";"):
            break
        body.append(line)
    return any(ORDERED.search(code_of(line, language)) for line in body)


def of_reviewer(lines, at, language=CPP, stateful=False):
    """[(operator, number of lines, what replaces them)]; `stateful`: the line is in a function that saves or restores."""
    line = lines[at]
    code = code_of(line, language)
    if language.no_code.search(code) or language.no_code.search(line):
        return []
    out = []
    one = lambda operator, text: out.append((operator, 1, text))
    indent = line[:len(line) - len(line.lstrip())]

    if re.match(r"^\s*if\b", code) and (whole := statement_at(lines, at, language)):  # with what it does, in a line of its own or not
        text, count = whole
        found = condition_of(code_of(text, language), language)
        if found and " else" not in code_of(text, language):
            then = re.sub(r"^\s*then\b", "", text[found[1]:]).strip()
            name = RIGHT if RIGHTS.search(code_of(text, language)[found[0]:found[1]]) else CHECK if REFUSALS.match(then) else LOG if LOGS.match(then) else None
            if name:
                out.append((name, count, indent + language.nothing))
    elif LOGS.match(code) and (whole := statement_at(lines, at, language)) and whole[1] > 1:
        out.append((LOG, whole[1], indent + language.nothing))
    if (language is CPP and re.match(r"^\s*(?:static |inline |virtual )*bool (?:\w+::)*\w+\(.*\{$", code) and RIGHTS.search(code)):
        one(RIGHT, f"{line} return true;")

    if stateful and language is CPP:
        if re.match(r"^\s*(f|saveFields|loadFields|append|(out|in)\.\w+)\(", code):
            for m in [*re.finditer(r"(?<=[(\s])[\w.]+, ", code), *re.finditer(r", [\w.]+(?=\))", code)]:
                one(STATE, line[:m.start()] + line[m.end():])
        if re.match(r"^\s*f\(\w+_?\);$", code) or re.match(r"^\s*(out|in|f|s|stream)(\.\w+|\b)\(.*\);$", code):
            one(STATE, indent + ";")
    for m in re.finditer(r"\.state\(\)", code):
        rest = line[:m.start()] + line[m.end():]
        if ".property(" in code or re.match(r"^\s*\.state\(\)$", code):
            one(STATE, rest)

    if m := {CPP: LOOP, TYPESCRIPT: LOOP_OF}.get(language, re.compile("(?!)")).match(line):
        end = closing(code, code.index("for (") + 4)
        if end > 0 and ordered(lines, at, language):
            what = f"std::views::reverse({line[m.end():end]})" if language is CPP else f"[...{line[m.end():end]}].reverse()"
            one(ORDER, line[:m.end()] + what + line[end:])
    if language is CPP and (m := COUNT.match(line)):
        if ordered(lines, at, language):
            one(ORDER, f"{m[1]}for ({m[2]} {m[3]} = {m[4]}; {m[3]}-- > 0;){m[5]}")
    if language is LUA and (m := re.match(r"^(\s*for \w+ = )(\w+), ([^,]+)( do\b.*)$", line)):
        one(ORDER, f"{m[1]}{m[3]}, {m[2]}, -1{m[4]}")

    if language.function.match(code) and STEPS.search(code):
        one(LATE, f"{line} static bool begun = false; if (!begun) {{ begun = true; return; }}")
    for m in re.finditer(r"\b(now|cycle)(\(\)|_)?(?= (?:[<>]=?|-) )", code):
        if m[1] == "cycle":
            one(LATE, f"{line[:m.end()]} - 1{line[m.end():]}")
    for m in TURNS.finditer(code):
        one(FRAME, line[:m.start()] + line[m.end():])
    for m in re.finditer(r"\b(?:rotation|orientation)(?:\(\)|_)?(?= \* )", code) if language is CPP else ():
        one(FRAME, f"{line[:m.end()]}.inverse(){line[m.end():]}")
    for a, b in FRAMES if language is CPP else ():
        for old, new in ((a, b), (b, a)):
            for m in re.finditer(rf"(?<=[.>])[a-z]*{old}(?:[A-Z]\w*|_)?\b", code):
                one(FRAME, line[:m.start()] + m[0].replace(old, new) + line[m.end():])
    for m in UNITS.finditer(code):
        if not re.match(r"^\s*(constexpr|inline|double|float|static|export|function)\b", code) or " = " in code[:m.start()]:
            one(UNIT, line[:m.start()] + line[m.end():])
    for m in FACTORS.finditer(code):
        one(UNIT, line[:m.start()] + line[m.end():])
    return out


# ---- both ----

def mutants_of(file, text):
    """[(identity of the line, its mutants)]; the identity is its text and the number of earlier lines with the same text."""
    language, lines = language_of(file), text.split("\n")
    seen, out, until = {}, [], None
    for at, line in enumerate(lines):
        seen[line] = seen.get(line, 0) + 1
        indent = len(line) - len(line.lstrip())
        if until is not None and line.strip() and indent <= until:
            until = None
        found = {}
        for operator, count, after in of_reviewer(lines, at, language, until is not None):
            found.setdefault((count, after), operator)
        for operator, after in of_compiler(line, language):
            if found.get((1, after)) is None:
                found[1, after] = operator
        if until is None and STATEFUL.search(code_of(line, language)):
            until = indent
        made = [Mutant(file, at + 1, "\n".join(lines[at:at + count]), after, operator) for (count, after), operator in found.items() if after != line]
        if made:
            out.append((f"{file}\0{line}\0{seen[line]}", made))
    return out


def apply(mutant, text):
    """The file's text with the mutant in it."""
    lines, old = text.split("\n"), mutant.before.split("\n")
    first = mutant.line - 1
    if lines[first:first + len(old)] == old:
        lines[first:first + len(old)] = [mutant.after, *[""] * (len(old) - 1)]
        text = "\n".join(lines)
        return "#include <ranges>\n#line 1\n" + text if "std::views::reverse" in mutant.after and mutant.file.endswith((".h", ".cpp")) else text
    if text.count(mutant.before) != 1:
        raise ValueError(f"{mutant.file}: no single '{mutant.before}'")
    return text.replace(mutant.before, mutant.after)
