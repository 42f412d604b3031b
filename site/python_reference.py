"""The reference of the Python package: signatures, defaults and docstrings, read from its files without importing it."""

from __future__ import annotations

import ast
import re
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent / "crates/catchment-py/python/catchment"

#: The names on the page, in reading order for a new user; a completeness test compares it with `__all__`.
CHAPTERS = {
    "Problems": ["load", "Problem"],
    "Answers": ["Result", "Report", "Picture", "End", "Ends", "Touching", "OUTCOMES"],
    "Studies": ["sweep", "compare", "methods"],
    "Errors": [
        "Error", "DesignError", "GeometryError", "ArgumentError", "MemoryLimitError", "ComputeError", "Diagnostic",
    ],
}
HEAD = """# Python reference

{made}Every public name of `catchment`, with its arguments and their defaults. [catchment from Python](../python.md) shows them at work. Lengths are in D, the width of the connector, and
angles in radians, unless written with a unit: `"5 mm"`, `"10 deg"`. Arrays of pose errors have the shape (n, 5): x, y, roll, pitch, yaw.
"""
WIDE = 100

Function = ast.FunctionDef | ast.AsyncFunctionDef


class Module:
    """A source file of the package, with the `#:` comments above its names."""

    def __init__(self, path: Path) -> None:
        text = path.read_text(encoding="utf-8")
        self.lines = text.splitlines()
        self.body = ast.parse(text).body

    def comment_above(self, node: ast.stmt) -> str:
        at, comment = node.lineno - 2, []
        while at >= 0 and self.lines[at].strip().startswith("#:"):
            comment.insert(0, self.lines[at].strip()[2:].strip())
            at -= 1
        return " ".join(comment)


def signature(name: str, function: Function, bound: bool, made: bool = False) -> str:
    """The signature as in the file: on one line if it is short enough; a constructor without its return type
    None."""
    given = function.args
    plain = given.posonlyargs + given.args
    defaults = [None] * (len(plain) - len(given.defaults)) + list(given.defaults)

    def written(argument: ast.arg, default: ast.expr | None) -> str:
        text = argument.arg + (f": {ast.unparse(argument.annotation)}" if argument.annotation else "")
        return text + (f" = {ast.unparse(default)}" if default is not None else "")

    words = [written(*pair) for pair in zip(plain, defaults)][1 if bound else 0 :]
    if given.kwonlyargs:
        words += ["*", *(written(*pair) for pair in zip(given.kwonlyargs, given.kw_defaults))]
    gives = f" -> {ast.unparse(function.returns)}" if function.returns and not made else ""
    short = f"{name}({', '.join(words)}){gives}"
    whole = short if len(short) <= WIDE else "\n    ".join([f"{name}(", *(f"{word}," for word in words)]) + f"\n){gives}"
    return whole.replace("'", '"').replace("_meshes.", "")


def markdown(text: str, names: set[str]) -> str:
    """A docstring as Markdown: argument descriptions become a list, lines after >>> a code block."""
    out: list[str] = []
    for paragraph in re.split(r"\n\s*\n", text.strip()):
        lines = [line.strip() for line in paragraph.splitlines()]
        if lines[0].startswith(">>>"):
            out.append("```pycon\n" + "\n".join(lines) + "\n```")
            continue
        whole: list[str] = []
        listed = False
        for line in lines:
            found = re.match(r"([a-z_0-9]+(?:, [a-z_0-9]+)*)( \([^)]*\))?: ", line)
            if found and set(found[1].split(", ")) <= names:
                whole += [] if listed or not whole else [""]
                whole.append(f"- **{found[1]}**{found[2] or ''}: {line[found.end():]}")
                listed = True
            elif listed and re.match(r"(Returns|Raises|Ctrl-C|Everything else)\b", line) and whole[-1].endswith("."):
                whole += ["", line]
                listed = False
            else:
                whole.append(f"  {line}" if listed else line)
        out.append("\n".join(whole))
    return "\n\n".join(out)


def arguments(function: Function) -> set[str]:
    return {argument.arg for argument in function.args.args + function.args.kwonlyargs}


def is_property(function: Function) -> bool:
    return any(isinstance(mark, ast.Name) and mark.id == "property" for mark in function.decorator_list)


def of_function(name: str, function: Function, level: str, bound: bool = False) -> str:
    description = markdown(ast.get_docstring(function) or "", arguments(function))
    return f"{level} {name}\n\n```python\n{signature(name, function, bound)}\n```\n\n{description}\n"


def attributes(module: Module, kind: ast.ClassDef) -> list[tuple[str, str, str]]:
    """Name, type and description of every readable attribute of an object: fields, assignments in `__init__`,
    properties."""
    found = []
    for node in kind.body:
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            found.append((node.target.id, ast.unparse(node.annotation), module.comment_above(node)))
        elif isinstance(node, ast.FunctionDef) and node.name == "__init__":
            for step in ast.walk(node):
                target = step.target if isinstance(step, ast.AnnAssign) else step.targets[0] if isinstance(step, ast.Assign) else None
                if isinstance(target, ast.Attribute) and (comment := module.comment_above(step)):
                    of = ast.unparse(step.annotation) if isinstance(step, ast.AnnAssign) else ""
                    found.append((target.attr, of, comment))
        elif isinstance(node, ast.FunctionDef) and is_property(node):
            of = ast.unparse(node.returns) if node.returns else ""
            found.append((node.name, of, " ".join((ast.get_docstring(node) or "").split())))
    return [one for one in found if not one[0].startswith("_")]


def of_class(module: Module, kind: ast.ClassDef) -> str:
    methods = [node for node in kind.body if isinstance(node, ast.FunctionDef)]
    made = next((node for node in methods if node.name == "__init__"), None)
    bases = [ast.unparse(base) for base in kind.bases if ast.unparse(base) != "NamedTuple"]
    description = markdown(ast.get_docstring(kind) or "", arguments(made) if made else set())
    text = f"### {kind.name}\n\n"
    if kind.name == "Problem" and made:
        text += f"```python\n{signature(kind.name, made, bound=True, made=True)}\n```\n\n"
    elif bases:
        text += f"*A kind of {', '.join(f'`{base}`' for base in bases)}.*\n\n"
    text += description + "\n"
    if rows := attributes(module, kind):
        text += "\n| attribute | type | description |\n|---|---|---|\n"
        for name, of, words in rows:
            text += f"| `{name}` | {f'`{of}`'.replace('|', chr(92) + '|') if of else ''} | {words.replace('|', chr(92) + '|')} |\n"
    for method in methods:
        if not method.name.startswith("_") and not is_property(method):
            text += "\n" + of_function(f"{kind.name}.{method.name}", method, "####", bound=True)
    return text


def page(made: str) -> str:
    modules = {path.stem: Module(path) for path in sorted(PACKAGE.glob("*.py"))}
    known: dict[str, tuple[Module, ast.stmt]] = {}
    for module in modules.values():
        for node in module.body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                # Of overloads the last one is the implementation.
                known[node.name] = (module, node)
            elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
                known[node.target.id] = (module, node)
    public = next(
        ast.literal_eval(node.value)
        for node in modules["__init__"].body
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__"
    )
    shown = [name for names in CHAPTERS.values() for name in names]
    if odd := set(public) - {"__version__"} ^ set(shown):
        raise SystemExit(f"site/python_reference.py and catchment.__all__ differ: {', '.join(sorted(odd))}")
    text = HEAD.format(made=made)
    for chapter, names in CHAPTERS.items():
        text += f"\n## {chapter}\n"
        for name in names:
            module, node = known[name]
            if isinstance(node, ast.ClassDef):
                text += "\n" + of_class(module, node)
            elif isinstance(node, ast.FunctionDef):
                text += "\n" + of_function(name, node, "###")
            else:
                text += f"\n### {name}\n\n```python\n{ast.unparse(node)}\n```\n\n{module.comment_above(node)}\n"
    text += "\n## Types of arguments\n\n| name | type | meaning |\n|---|---|---|\n"
    for module, node in ((modules[name], node) for name in ("_arguments", "_meshes") for node in modules[name].body):
        if isinstance(node, ast.AnnAssign) and ast.unparse(node.annotation) == "TypeAlias":
            of = ast.unparse(node.value).replace("|", "\\|")
            text += f"| `{ast.unparse(node.target)}` | `{of}` | {module.comment_above(node)} |\n"
    return text
