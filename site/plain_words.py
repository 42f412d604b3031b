"""Plain words: frequency of the words that make the project's prose hard to read, checked against limits.

    python3 site/plain_words.py                 one line per page, then the total
    python3 site/plain_words.py docs/window.md  one page, each use with its line
    python3 site/plain_words.py --check         exits with 1 if a limit is exceeded, a banned phrase remains or a code block is too wide

Counted per 1 000 words of the README, docs/ (prose, tables and the program's output in them) and docs/reference/ (the program's help, design keys and report fields). Inline code, code blocks
other than output, links and addresses do not count. `GUIDES` are pages that address the reader.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

# Most uses per 1 000 words.
LIMITS = {
    "what": (3.0, r"what"),
    "told": (1.5, r"told|tells?|says?|said"),
    "where": (3.0, r"where"),
    "one/none": (4.0, r"one|none|nobody"),
    "otherwise": (0.3, r"otherwise"),
}
# Fewest uses per 1 000 words of guides.
YOU = 8.0
GUIDES = ["README", "first-dock", "parts", "window", "success", "jams", "rests", "friction", "hold", "plan", "validate", "sweep", "trials",
          "viewer", "python", "pictures", "methods", "other-tools", "budget-to-window", "compose", "latch", "chain", "invert", "chance"]

# Phrases that have a plain form. docs/versions.md lists former names, and quotes them.
PHRASES = [
    r"fares?\b", r"cells? of doubt", r"what is forgiven", r"the window one may ship", r"rotation length", r"how far one radian counts",
    r"(what )?becomes? of\b", r"comes to rest where", r"what is off", r"as sure as", r"at most so many", r"foretold", r"drawn askew", r"asks nobody",
    r"(is|are|was|were) told", r"stops nothing", r"joined others", r"each alone", r"any push", r"goes on as", r"comes by", r"ends? otherwise",
    r"the way out", r"complaints?\b", r"misfits?\b", r"how far off", r"what carries", r"what holds it",
]
EXEMPT = {"docs/versions.md"}
# Columns of a code block that fit beside the site's navigation. The kept output of a long measurement is wider.
WIDTH = 80
WIDE = {"docs/accuracy-coverage.md"}
OUTPUT = {"console", "text"}


def pages():
    return [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def prose(text):
    """The text line by line, without the parts that do not count."""
    language = None
    for number, line in enumerate(text.splitlines(), 1):
        fence = re.match(r"\s*```(\w*)", line)
        if fence:
            language = fence.group(1) if language is None else None
            continue
        if language is not None and (language not in OUTPUT or line.startswith("$")):
            continue
        line = re.sub(r"`[^`]*`|\]\([^)]*\)|https?://\S+|<!--.*?-->", " ", line)
        yield number, line


def too_wide(text):
    """The lines of code blocks that do not fit, fenced or indented by four spaces."""
    fenced, above = False, ""
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("```"):
            fenced = not fenced
        elif fenced:
            if len(line) > WIDTH:
                yield number, line
        elif line.startswith("    "):
            # Indented text below a note or an item of a list is no code.
            if len(line) > WIDTH + 4 and not re.match(r"!!!|[-*] |\d+\.", above):
                yield number, line
        elif line:
            above = line


def words(lines):
    return sum(len(re.findall(r"[^\W\d_]+(?:'[a-z]+)?", line)) for _, line in lines)


def uses(lines, pattern):
    pattern = re.compile(rf"\b(?:{pattern})\b", re.IGNORECASE)
    return [(number, line.strip()) for number, line in lines for _ in pattern.findall(line)]


def phrases(lines):
    pattern = re.compile("|".join(rf"\b(?:{phrase})" for phrase in PHRASES), re.IGNORECASE)
    return [(number, found.group(), line.strip()) for number, line in lines for found in pattern.finditer(line)]


def main(arguments):
    check = "--check" in arguments
    requested = [Path(name).resolve() for name in arguments if not name.startswith("-")]
    shown = requested or pages()
    total, counts, guides, you = 0, dict.fromkeys(LIMITS, 0), 0, 0
    failures = []
    if not check:
        print(f"{'page':40} {'words':>6} " + " ".join(f"{name:>9}" for name in [*LIMITS, "you"]))
    for page in shown:
        name = page.relative_to(ROOT).as_posix()
        lines = list(prose(page.read_text(encoding="utf-8")))
        number = words(lines)
        total += number
        row = []
        for label, (_, pattern) in LIMITS.items():
            found = uses(lines, pattern)
            counts[label] += len(found)
            row.append(1000 * len(found) / max(number, 1))
            if requested and not check:
                for place, line in found:
                    print(f"  {name}:{place}: {label}: {line[:160]}")
        addressed = len(uses(lines, r"you|your|yours|yourself"))
        row.append(1000 * addressed / max(number, 1))
        if page.stem in GUIDES and "reference" not in name:
            guides += number
            you += addressed
        if name not in EXEMPT:
            for place, phrase, line in phrases(lines):
                failures.append(f"{name}:{place}: “{phrase}” has a plain form: {line[:120]}")
        if "reference" not in name and name not in WIDE:
            failures += [f"{name}:{place}: {len(line)} characters in a code block, {WIDTH} fit" for place, line in too_wide(page.read_text(encoding="utf-8"))]
        if not check:
            print(f"{name:40} {number:6} " + " ".join(f"{rate:9.1f}" for rate in row))
    rates = {label: 1000 * count / max(total, 1) for label, count in counts.items()}
    if not check:
        print(f"{'all':40} {total:6} " + " ".join(f"{rate:9.2f}" for rate in rates.values()) + f" {1000 * you / max(guides, 1):9.2f} (guides)")
    if not requested:
        failures += [f"“{label}” stands {rates[label]:.2f} times in 1 000 words, at most {most} may" for label, (most, _) in LIMITS.items() if rates[label] > most]
        if 1000 * you / max(guides, 1) < YOU:
            failures.append(f"the guides address the reader {1000 * you / max(guides, 1):.2f} times in 1 000 words, at least {YOU} is wanted")
    for failure in failures:
        print(failure)
    if check:
        print(f"plain words: {len(failures)} failures in {total} words")
    return 1 if check and failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
