"""The pages are readable: no sentence above 40 words, a README of 700 to 900 words, no link that leads nowhere, whole rows of tables.

words_test.py SOURCE [PAGE...]

Without PAGE: the README, docs/ and the READMEs of the case studies. Links of the other pages of the first folder (CHANGELOG.md,
SECURITY.md, NOTICE.md) are followed too, and so are their tables. Every finding is printed with file and line.

Code blocks, tables and headings are no sentences. A link counts with its text, inline code and a formula as one word each. An item of
a list ends its sentence. Anchors are GitHub's: lower case, without punctuation, hyphens for spaces, -1 behind the second of a name.
"""

import pathlib
import re
import sys

LONGEST_SENTENCE = 40
README_WORDS = range(700, 901)
ENDS = re.compile(r"[.!?][)\"'”*_]*\s+(?=[^a-z\s])")  # a small letter goes on with the sentence
NO_END = re.compile(r"(?:^|[\s(])(?:e\.g|i\.e|et al|cf|vs|eqs?|Eqs?|figs?|Figs?|approx|[A-Z])\.$")  # abbreviations, and initials of names


def without_code_blocks(lines):
    """The page's lines, empty where a block of code was: fenced, or indented by four after an empty line."""
    fence, indented, kept = None, False, []
    for line in lines:
        mark = re.match(r"\s*(```+|~~~+)", line)
        if fence:
            kept.append("")
            fence = None if mark and mark.group(1).startswith(fence) else fence
            continue
        if mark:
            fence = mark.group(1)
            kept.append("")
            continue
        starts_block = line.startswith("    ") and not (kept and kept[-1].strip())
        in_list = starts_block and is_in_list(kept)
        indented = (starts_block and not in_list) or (indented and (line.startswith("    ") or not line.strip()))
        kept.append("" if indented else line)
    return kept


def is_in_list(before):
    """Whether the last line with text before an indented one belongs to a list, so that the indented one goes on with it."""
    last = next((line for line in reversed(before) if line.strip()), "")
    return bool(re.match(r"\s*([-*+]|\d+\.)\s", last)) or last.startswith("  ")


def plain(text):
    """Text as it is read: links by their words, inline code and formulas as one word, no pictures and no tags."""
    text = re.sub(r"(`+)(?:(?!`).)+?\1", " code ", text, flags=re.DOTALL)
    text = re.sub(r"\$[^$\n]+\$", " formula ", text)
    text = re.sub(r"!\[[^\]]*\]\([^)]*\)", " ", text)
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)
    return re.sub(r"<[^>]+>", " ", text)


def paragraphs(lines):
    """(line number, text) of every paragraph and item of a list; tables and headings are left out."""
    number, text = 0, []
    for n, line in enumerate([*without_code_blocks(lines), ""], 1):
        left_out = not line.strip() or re.match(r"\s*(\||#+ |---+\s*$|===+\s*$)", line)
        item = re.match(r"\s*(?:[-*+]|\d+\.)\s+", line)
        if (left_out or item) and text:
            yield number, "\n".join(text)
            text = []
        if not left_out:
            number = n if not text else number
            text.append(line[item.end():] if item else line)


def sentences(text):
    """(offset of its line, sentence) of a paragraph."""
    begin = 0
    for end in [*ENDS.finditer(text), None]:
        stop = len(text) if end is None else end.end()
        if end is not None and NO_END.search(text[begin:end.start() + 1]):
            continue
        yield text.count("\n", 0, begin), " ".join(text[begin:stop].split())
        begin = stop


def n_words(sentence):
    return sum(1 for word in plain(sentence).split() if re.search(r"\w", word))


def long_sentences(name, lines):
    for number, text in paragraphs(lines):
        for offset, sentence in sentences(text):
            n = n_words(sentence)
            if n > LONGEST_SENTENCE:
                yield f"{name}:{number + offset}: a sentence of {n} words: {sentence}"


def anchors(page):
    found, seen = set(), {}
    for line in without_code_blocks(page.read_text().splitlines()):
        heading = re.match(r"#{1,6}\s+(.*?)\s*#*\s*$", line)
        if heading:
            words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading.group(1)).lower()
            slug = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
            again = seen[slug] = seen.get(slug, -1) + 1
            found.add(f"{slug}-{again}" if again else slug)
        found.update(re.findall(r'(?:id|name)="([^"]+)"', line))
    return found


def dangling_links(source, page, lines):
    for number, line in enumerate(without_code_blocks(lines), 1):
        for target in re.findall(r"\]\(\s*<?([^)\s>]+)", re.sub(r"(`+)(?:(?!`).)+?\1", "", line)):
            if re.match(r"[a-z]+:", target):
                continue  # another server's
            path, _, anchor = target.partition("#")
            leads_to = (page.parent / path).resolve() if path else page
            if not leads_to.exists() or source not in [leads_to, *leads_to.parents]:
                yield f"{page.relative_to(source)}:{number}: a link to {target}, which is not there"
            elif anchor and leads_to.suffix == ".md" and anchor not in anchors(leads_to):
                yield f"{page.relative_to(source)}:{number}: a link to {target}: that page has no such heading"


def broken_tables(name, lines):
    """Rows that have another number of cells than the heading, or are wrapped to the next line."""
    n_cells = None
    for number, line in enumerate([*without_code_blocks(lines), ""], 1):
        cells = re.split(r"(?<!\\)\|", re.sub(r"(`+)(?:(?!`).)+?\1", "code", line.strip()))
        if re.match(r"\s*\|[-:| ]*-[-:| ]*\|\s*$", line):
            n_cells = len(cells)
        elif not line.strip():
            n_cells = None
        elif n_cells and len(cells) != n_cells:
            yield f"{name}:{number}: a row of {len(cells) - 2} cells in a table of {n_cells - 2}"


def findings(source, page, has_prose):
    lines, name = page.read_text().splitlines(), page.relative_to(source)
    if has_prose:
        yield from long_sentences(name, lines)
        n = len(page.read_text().split())
        if page == source / "README.md" and n not in README_WORDS:
            yield f"{name}:1: {n} words, must have {README_WORDS[0]} to {README_WORDS[-1]}"
    yield from dangling_links(source, page, lines)
    yield from broken_tables(name, lines)


def check_the_linter():
    """What it must find, and what it must not."""
    long_one = " ".join(["word"] * 41)
    assert len(list(long_sentences("a", [long_one + "."]))) == 1
    assert not list(long_sentences("a", ["| " + long_one + " |"])) and not list(long_sentences("a", ["```", long_one, "```"]))
    assert not list(long_sentences("a", ["x:", "", "    " + long_one])) and not list(long_sentences("a", ["# " + long_one]))
    assert len(list(long_sentences("a", ["- item", "", "    " + long_one]))) == 1
    table = ["| a | b |", "|---|---|", "| 1 | `x|y` |"]
    assert not list(broken_tables("a", [*table, "", "text"]))
    assert [line.split()[0] for line in broken_tables("a", [*table, "| 1 | begun", "here | | 2 | 3 |"])] == ["a:4:", "a:5:"]
    half = " ".join(["word"] * 21)
    assert not list(long_sentences("a", [f"{half}.", f"Then {half}."])) and not list(long_sentences("a", [f"- {half}", f"- {half}"]))
    assert [line.split()[0] for line in long_sentences("a", ["One.", f"Two {half}", f"{half}."])] == ["a:2:"]
    assert len(list(long_sentences("a", [f"{half} e.g. {half}."]))) == 1
    assert n_words("[two words](a/long/target.md) and `one of code` ![a picture](x.svg) - 5 %") == 5


def main():
    check_the_linter()
    source = pathlib.Path(sys.argv[1]).resolve()
    prose = [source / "README.md", *sorted(source.glob("docs/**/*.md")), *sorted(source.glob("cases/studies/*/README.md"))]
    pages = [pathlib.Path(word).resolve() for word in sys.argv[2:]] or [*prose, *sorted(set(source.glob("*.md")) - set(prose))]
    found = [finding for page in pages for finding in findings(source, page, page in prose)]
    print("\n".join(found) or f"{len(pages)} pages read, nothing found")
    if found:
        print(f"{len(found)} findings")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
