"""Small defects that scripts/check/mutate puts into C++ source text.

The patterns below rely on clang-format: it puts blanks around binary operators, and none around those of types, templates
and pointers. A defect that makes no sense does not compile, and the caller throws it away.
"""

import dataclasses
import hashlib
import re

COMPARISONS = {"<": ("<=", ">"), "<=": ("<", ">="), ">": (">=", "<"), ">=": (">", "<="), "==": ("!=",), "!=": ("==",)}
OPERATORS = {"+": "-", "-": "+", "*": "/", "/": "*", "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=", "&&": "||", "||": "&&"}
WORDS = {"min": "max", "max": "min"}
PAIRS = {"(": ")", "[": "]", "{": "}"}
# Messages and checks at compile time. Nothing changes from here to the end of the statement or of the call.
MESSAGES = re.compile(r"\b(throw|using|static_assert|friend|goto)\b|\b(assert|fmt::format|(\w+(\.|->))?fail)\(")


@dataclasses.dataclass(frozen=True)
class Mutant:
    """One defect: a line and what it becomes."""
    file: str
    line: int  # from 1
    kind: str
    before: str  # the whole line
    after: str

    @property
    def id(self):
        """An identifier that does not depend on the line number."""
        text = "\n".join((self.file, self.kind, self.before.strip(), self.after.strip()))
        return hashlib.sha1(text.encode()).hexdigest()[:8]


def blank_out(text, begin, end):
    """The same text with blanks from begin to end; line breaks stay."""
    return text[:begin] + re.sub(r"[^\n]", " ", text[begin:end]) + text[end:]


def without_words(text):
    """The same text with blanks for comments, characters, the insides of strings and preprocessor lines."""
    pattern = re.compile(
        r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![\w])\'(?:\\.|[^\'\\\n])+\'|^[ \t]*#(?:\\\n|[^\n])*',
        re.DOTALL | re.MULTILINE)

    def blanks(match):
        word = match.group()
        if word[0] == '"' and len(word) > 1:
            return '"' + " " * (len(word) - 2) + '"'
        return re.sub(r"[^\n]", " ", word)
    return pattern.sub(blanks, text)


def closing(code, begin):
    """The place of the bracket that closes the one at `begin`, or None."""
    depth = 0
    for i in range(begin, len(code)):
        if code[i] in "([{":
            depth += 1
        elif code[i] in ")]}":
            depth -= 1
            if depth == 0:
                return i
    return None


def without_messages(code):
    """The same text with blanks for messages and template heads. What comes before a message in its statement stays."""
    for match in reversed(list(MESSAGES.finditer(code))):
        if match.group(2):
            end = closing(code, match.end() - 1) or match.end()
        else:
            end = code.find(";", match.end())
        code = blank_out(code, match.start(), max(end, match.end()))
    for match in reversed(list(re.finditer(r"\btemplate <", code))):
        depth, end = 0, match.end() - 1
        while end < len(code):
            depth += {"<": 1, ">": -1}.get(code[end], 0)
            end += 1
            if depth == 0:
                break
        code = blank_out(code, match.start(), end)
    return re.sub(r"\boperator\s*[^\w\s(]+", lambda m: " " * len(m.group()), code)


def kind_of_block(head, outer):
    """The kind of block that a brace opens: 'code', 'names' (namespaces, classes) or 'enum'. head: the text before it."""
    if re.search(r"\benum\b", head):
        return "enum"
    if outer == "code" and not re.search(r"\b(struct|class|union)\s+\w*\s*$", head):
        return "code"
    if re.search(r"\bnamespace\b|\bextern\b", head):
        return "names"
    if re.search(r"\b(class|struct|union)\b", head) and "(" not in head:
        return "names"
    return "code"


def scopes_of_lines(code):
    """The kind of block in which each line begins."""
    stack, result = ["names"], []
    begin = 0
    for i, c in enumerate(code + "\n"):
        if not result or (i and code[i - 1] == "\n"):
            result.append(stack[-1])
        if c == "{":
            stack.append(kind_of_block(code[begin:i], stack[-1]))
        elif c == "}" and len(stack) > 1:
            stack.pop()
        if c in "{};":
            begin = i + 1
    return result


def operand_end(code, begin):
    """The end of the operand that begins there: a name or number with its calls, indices and members."""
    match = re.compile(r"[-+!~]?(?:_cast<[\w:<> ]*>(?=\()|[\w:.']|->)*").match(code, begin)
    end = match.end()
    while end < len(code) and code[end] in PAIRS:
        end = closing(code, end)
        if end is None:
            return None
        end = re.compile(r"(?:(?:\.|->)[\w:]+)?").match(code, end + 1).end()
    return end if end > begin else None


def changed_operators(code):
    for match in re.finditer(r"(?<= )([-+*/<>=!&|]{1,2})(?= |$)", code):
        sign = match.group()
        if code[match.start() - 2] == '"' or code[match.end() + 1:match.end() + 2] == '"':
            continue  # concatenated text
        for other in COMPARISONS.get(sign, ()):
            yield "comparison", match.start(), match.end(), other
        if sign in OPERATORS:
            yield "operator", match.start(), match.end(), OPERATORS[sign]
    for match in re.finditer(r"(?<=::|\W\.)(min|max)(?=\()|(?<=\w\.|[\])]\.)(min|max)(?=\()", code):
        yield "min and max", match.start(), match.end(), WORDS[match.group()]


def other_numbers(text):
    """The numbers that can replace a number."""
    if re.fullmatch(r"\d+[uUlL]*", text):
        digits = re.match(r"\d+", text).group()
        suffix = text[len(digits):]
        value = int(digits)
        return [f"{v}{suffix}" for v in sorted({value + 1, value - 1, 0}) if v >= 0 and v != value]
    match = re.fullmatch(r"(\d+\.\d*(?:e[-+]?\d+)?)(f?)", text)
    if not match:
        return []
    value = float(match.group(1))
    others = {0.0: (1.0,), 1.0: (0.0, 2.0), 0.5: (1.0,), 2.0: (1.0,)}.get(value, (2.0 * value, 0.5 * value))
    return [f"{v!r}{match.group(2)}" for v in others]


def changed_constants(code):
    for match in re.finditer(r"(?<![\w.'])\d+(?:\.\d*)?(?:e[-+]?\d+)?[fuUlL]*(?![\w.'])", code):
        for other in other_numbers(match.group()):
            yield "constant", match.start(), match.end(), other


def dropped_factors(code):
    for match in re.finditer(r"(?<=[\w)\]]) [*/] (?=\S)", code):
        end = operand_end(code, match.end())
        if end is not None:
            yield "dropped factor", match.start(), end, ""


def may_be_swapped(first, second):
    """Whether both are texts or both are not, and neither is a part of a type."""
    return (first and second and first != second and first.startswith('"') == second.startswith('"') and
            not any(argument.count("<") != argument.count(">") for argument in (first, second)))


def swapped_arguments(code):
    for opening in re.finditer(r"(?<=\w)(?<!min)(?<!max)\(", code):
        end = closing(code, opening.start())
        if end is None:
            continue
        inside = code[opening.end():end]
        depth, cuts = 0, [-2]
        for i, c in enumerate(inside):
            depth += (c in "([{") - (c in ")]}")
            if c == "," and depth == 0 and inside[i + 1:i + 2] == " ":
                cuts.append(i)
        cuts.append(len(inside))
        for a, b, c in zip(cuts, cuts[1:], cuts[2:]):
            first, second = inside[a + 2:b], inside[b + 2:c]
            if may_be_swapped(first.strip(), second.strip()):
                begin, end = opening.end() + a + 2, opening.end() + c
                yield "swapped arguments", begin, end, ((opening.end() + b + 2, end), ", ", (begin, opening.end() + b))


def statement_begin(code):
    """The column after blanks, `else`, and the heads of conditions and loops on the same line."""
    at = len(code) - len(code.lstrip())
    while True:
        match = re.compile(r"(\} )?else (?!\{)|(?:if|for|while) \(|case [\w:]+: |default: ").match(code, at)
        if not match:
            return at
        at = match.end()
        if match.group().endswith("("):
            end = closing(code, at - 1)
            if end is None:
                return None
            at = end + 1
            at += len(code[at:]) - len(code[at:].lstrip())


def dropped_statements(code):
    at = statement_begin(code)
    if at is None or not code.rstrip().endswith(";"):
        return
    end = len(code.rstrip())
    statement = code[at:end - 1]
    bare = re.sub(r"\[[^\[\]]*\]|\([^()]*\)", "", re.sub(r"\[[^\[\]]*\]|\([^()]*\)", "", statement))
    is_change = re.match(r"\*?[\w.:>-]+ (?:[-+*/|&^%]|<<|>>)?= \S", bare) or re.fullmatch(r"(\+\+|--)[\w.:>-]+", bare)
    is_call = re.fullmatch(r"[\w.:>-]+", bare) and statement.endswith(")")
    if (is_change or is_call) and statement.count("(") == statement.count(")"):
        yield "dropped statement", at, end, ";"


def negated_conditions(code):
    for match in re.finditer(r"\b(?:if|while) \(", code):
        end = closing(code, match.end() - 1)
        if end is not None and not re.search(r"\w+[*&]? \w+ = ", code[match.end():end]):
            yield "negated condition", match.end(), end, ("!(", (match.end(), end), ")")


def removed_exits(code, line_before):
    """Exits under a condition. The last return of a function stays."""
    match = re.search(r"\b(?:return\b[^;]*|continue|break);$", code.rstrip())
    if not match:
        return
    at = statement_begin(code)
    guarded = re.match(r"\s*(\} )?(if|else)\b", code) or re.search(r"\bif \(.*[{)]$|\belse( \{)?$", line_before.rstrip())
    if at == match.start() and guarded:
        yield "removed exit", match.start(), match.end(), ";"


def changes(code, line_before, scope):
    """Yields (kind, begin, end, replacement: text, or texts and columns of the line)."""
    yield from changed_operators(code)
    yield from changed_constants(code)
    yield from dropped_factors(code)
    yield from swapped_arguments(code)
    if scope != "code":
        return
    yield from dropped_statements(code)
    yield from negated_conditions(code)
    yield from removed_exits(code, line_before)


def initialiser_only(code):
    """Keeps the value of a constant or of a member in a line outside functions. The rest becomes blanks."""
    match = re.match(r"[^(=]* = ", code)
    return blank_out(code, 0, match.end()) if match and "= default" not in code and "= delete" not in code else ""


def mutants_of(text, file):
    """{line number: its mutants}, for every executable line."""
    code = without_messages(without_words(text))
    lines, originals = code.split("\n"), text.split("\n")
    result = {}
    for number, scope in enumerate(scopes_of_lines(code)[:len(lines)]):
        line = lines[number]
        if scope == "enum" or re.match(r"\s*enum\b", line):
            continue
        if scope == "names":
            line = initialiser_only(line)
        before = originals[number]
        found = {}
        for kind, begin, end, other in changes(line, lines[number - 1] if number else "", scope):
            parts = (other,) if isinstance(other, str) else other
            text_there = "".join(part if isinstance(part, str) else before[slice(*part)] for part in parts)
            after = before[:begin] + text_there + before[end:]
            if after != before:
                mutant = Mutant(file, number + 1, kind, before, after)
                found.setdefault(after, mutant)
        if found:
            result[number + 1] = list(found.values())
    return result


def with_mutant(text, mutant):
    lines = text.split("\n")
    assert lines[mutant.line - 1] == mutant.before, f"{mutant.file}:{mutant.line} is another line now"
    lines[mutant.line - 1] = mutant.after
    return "\n".join(lines)
