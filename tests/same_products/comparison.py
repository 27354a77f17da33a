"""Where the files of two folders first differ, apart from what tests/same-products says may differ.

Texts are compared line by line, JSON value by value, FITS card by card and pixel by pixel, tables of casacore column by column, and
everything else byte by byte."""
import collections
import csv
import json
import os
import re

import numpy
from casacore import tables

Build = collections.namedtuple("Build", "folder version")  # where its runs lie, and `misfit 0.1.0`

DURATION = r"(?:\d+ (?:min|h) \d+ (?:s|min)|[\d.]+ m?s)"
# What clocks decide, by the ends of files' names: patterns, and what they are read as.
MEASURED = {
    ".ranks.err": [(rf"(?m)^(planes|images) \d+ to \d+ of \d+ +{DURATION}\n", "")],  # which planes a rank makes, and when
    ".err": [(rf"(?m)^(.{{24,}}?) *{DURATION}$", r"\1 <measured>")],
    ".out": [(r"(?m)^expected time: .*", "<measured>"), (r"(?m)^expected: (open|plan|total) .*", r"\1 <measured>")],
    ".html": [(r"<dt>Run</dt><dd>.*?</dd>", "<measured>"), (r'(?s)<svg class="bar".*?</svg>', "<measured>"),
              (r'<tr><td><i class="swatch s\d"></i>.*?</tr>\n?', ""), (r"(?m)^.*<b>wall clock</b>.*", "<measured>"),
              (r"<tr><td>expected time</td>.*?</td>", "<measured>"),
              (r"<tr><td>exchanged among ranks</td><td>.*?</td><td>\d+ messages", "<measured>"),
              (rf"exchanges, in {DURATION} of rank 0", "<measured>")],
}
MEASURED_DECISIONS = ("expected time", "exchanged among ranks")  # of the plan
# Values of report.json; the names of stages are compared. What has passed when the plan is made is its own expectation.
MEASURED_VALUES = r".*\.timings_s\.[^.]*|.*\.timings_expected_s\.(open|plan|total)|\.(memory_gib_peak|version)"


def without_builds(text, build):
    """What a build wrote, without the names of its folder and version."""
    return text.replace(str(build.folder), "<folder>").replace(build.version, "<version>")


def excerpt(text, at):
    return text[max(0, at - 30):at + 70]


def first_line(old, new):
    """The first line in which texts differ; None where none does."""
    if old == new:
        return None
    old, new = old.splitlines() + ["<end>"], new.splitlines() + ["<end>"]
    line = next((i for i, (a, b) in enumerate(zip(old, new)) if a != b), min(len(old), len(new)) - 1)
    column = len(os.path.commonprefix([old[line], new[line]]))
    return f"line {line + 1}: «{excerpt(old[line], column)}» / «{excerpt(new[line], column)}»"


def text_difference(old, new, name):
    for end, patterns in MEASURED.items():
        for pattern, shown in patterns if name.endswith(end) else []:
            old, new = re.sub(pattern, shown, old), re.sub(pattern, shown, new)
    return first_line(old, new)


def is_measured(value):
    return re.fullmatch(MEASURED_VALUES, value)


def json_difference(old, new, at=""):
    """Where values first differ; numbers are compared as they are written, and members in their order."""
    if isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        pairs = [(f"[{i}]", a, b) for i, (a, b) in enumerate(zip(old, new))]
        if all(isinstance(item, tuple) for item in old + new):  # members of an object
            if [name for name, _ in old] != [name for name, _ in new]:
                return f"{at}: members {[name for name, _ in old]} / {[name for name, _ in new]}"
            if any(("item", item) in old and ("item", item) in new for item in MEASURED_DECISIONS):
                return None
            pairs = [(f".{a[0]}", a[1], b[1]) for a, b in zip(old, new) if not is_measured(f"{at}.{a[0]}")]
        found = (json_difference(a, b, at + name) for name, a, b in pairs)
        return next((difference for difference in found if difference), None)
    return None if old == new else f"{at}: {old!r} / {new!r}"


def members(text):
    """JSON whose objects are lists of pairs and whose numbers are texts."""
    return json.loads(text, object_pairs_hook=list, parse_float=str, parse_int=str, parse_constant=str)


def csv_difference(old, new, ignored):
    """Without the columns whose names are among `ignored`."""
    def kept(text):
        rows = list(csv.reader(text.splitlines()))
        columns = [i for i, name in enumerate(rows[0]) if name not in ignored]
        return "\n".join(",".join(row[i] for i in columns if i < len(row)) for row in rows)
    return first_line(kept(old), kept(new)) if ignored and old and new else first_line(old, new)


# FITS

DATED = ("DATE    ", "CHECKSUM", "DATASUM ")  # cards that hold when they were written; a sum of the data says no more than the data


def header_units(content):
    """(cards, keywords, data) of each header-data unit; see the FITS standard 4.0, section 4.4.1."""
    at = 0
    while at < len(content):
        cards, keywords = [], {}
        while not cards or not cards[-1].startswith("END "):
            block = content[at:at + 2880].decode("ascii", "replace")
            if not block:
                raise ValueError("a header without END")
            cards += [block[i:i + 80] for i in range(0, len(block), 80)]
            while cards[-1].strip() == "" and len(cards) > 1:
                cards.pop()
            at += 2880
        for card in cards:
            if card[8:10] == "= ":
                keywords[card[:8].strip()] = card[10:].split(" /")[0].strip()
        shape = [int(keywords[f"NAXIS{i}"]) for i in range(int(keywords["NAXIS"]), 0, -1)]
        elements = int(keywords.get("GCOUNT", 1)) * (int(keywords.get("PCOUNT", 0)) + int(numpy.prod(shape)) if shape else 0)
        size = abs(int(keywords["BITPIX"])) // 8 * elements
        yield cards, shape, int(keywords["BITPIX"]), content[at:at + size]
        at += -(-size // 2880) * 2880


def data_difference(old, new, shape, bits):
    if old == new:
        return None
    if len(old) != len(new):
        return f"{len(old)} / {len(new)} bytes of data"
    if bits not in (-32, -64):
        return byte_difference(old, new)
    kind = numpy.dtype(">f4" if bits == -32 else ">f8")
    words = kind.str.replace("f", "u")
    apart = numpy.flatnonzero(numpy.frombuffer(old, words) != numpy.frombuffer(new, words))
    a, b = numpy.frombuffer(old, kind), numpy.frombuffer(new, kind)
    largest = numpy.nanmax(numpy.abs(a[apart].astype(float) - b[apart]), initial=0)
    pixel = ", ".join(str(i) for i in numpy.unravel_index(apart[0], shape))
    return (f"element [{pixel}]: {a[apart[0]]} / {b[apart[0]]}; {len(apart)} of {len(a)} differ, by at most {largest:.3g}, "
            f"{largest / max(numpy.nanmax(numpy.abs(a)), 1e-300):.2g} of the largest")


def fits_difference(old, new, builds):
    units = [list(header_units(content)) for content in (old, new)]
    if len(units[0]) != len(units[1]):
        return f"{len(units[0])} / {len(units[1])} header-data units"
    for i, (a, b) in enumerate(zip(*units)):
        texts = ["\n".join(without_builds(card, build).rstrip() for card in unit[0] if not card.startswith(DATED))
                 for unit, build in zip((a, b), builds)]
        found = [difference for difference in (first_line(*texts), data_difference(a[3], b[3], a[1], a[2])) if difference]
        if found:
            return f"unit {i + 1}, " + "; ".join(found)
    return None


# Tables of casacore


def own_files(folder):
    return {file.name: file for file in folder.iterdir() if file.is_file() and file.name != "table.lock"}


def same_bytes(old, new):
    return own_files(old).keys() == own_files(new).keys() and all(
        file.read_bytes() == (new / name).read_bytes() for name, file in own_files(old).items())


def cell(table, column, row):
    return table.getcell(column, row) if table.iscelldefined(column, row) else None


def in_order(value):
    """The text of records, whose fields Python has in any order, and of arrays, whose elements it leaves out."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{name}: {in_order(value[name])}" for name in sorted(value)) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(in_order, value)) + "]"
    return f"{value.dtype}{value.shape} {value.tolist()}" if isinstance(value, numpy.ndarray) else repr(value)


def bits(value):
    return (value.dtype.str, value.shape, value.tobytes()) if isinstance(value, numpy.ndarray) else repr(value)


def column_difference(old, new, column):
    for row in range(old.nrows()):
        a, b = cell(old, column, row), cell(new, column, row)
        if bits(a) != bits(b):
            if isinstance(a, numpy.ndarray) and isinstance(b, numpy.ndarray) and a.shape == b.shape and a.dtype == b.dtype:
                of_elements = [numpy.frombuffer(c.tobytes(), numpy.uint8).reshape(c.size, -1) for c in (a, b)]
                at = numpy.flatnonzero((of_elements[0] != of_elements[1]).any(axis=1))[0]
                a, b = a.ravel()[at], b.ravel()[at]
            return f"column {column}, row {row}: {a} / {b}"
    return None


def table_difference(old, new, builds):
    """By content where the bytes differ: keywords, columns, their storage and cells, but for times in logs."""
    if same_bytes(old, new):
        return None
    log = old.name in ("logtable", "HISTORY")
    with tables.table(str(old), ack=False) as a, tables.table(str(new), ack=False) as b:
        facts = [(("columns", t.colnames()), ("rows", t.nrows()), ("keywords", t.getkeywords()),
                  ("descriptions", [t.getcoldesc(name) for name in t.colnames()]),
                  ("storage", [(s["NAME"], s["TYPE"], sorted(s["COLUMNS"])) for s in t.getdminfo().values()])) for t in (a, b)]
        for (name, of_old), (_, of_new) in zip(*facts):
            texts = [without_builds(in_order(of), build) for of, build in zip((of_old, of_new), builds)]
            if texts[0] != texts[1]:
                return f"{name}, {first_line(*texts)}"
        found = (column_difference(a, b, name) for name in a.colnames() if not (log and name == "TIME"))
        return next((difference for difference in found if difference), None)


# Files and folders


def byte_difference(old, new):
    if old == new:
        return None
    at = next((i for i, (a, b) in enumerate(zip(old, new)) if a != b), min(len(old), len(new)))
    return f"byte {at} of {len(old)} / {len(new)}: {old[at:at + 12]!r} / {new[at:at + 12]!r}"


def file_difference(old, new, builds, ignored):
    contents = [file.read_bytes() for file in (old, new)]
    if contents[0] == contents[1]:
        return None
    if contents[0].startswith(b"SIMPLE  ="):
        return fits_difference(*contents, builds)
    if old.suffix not in (".err", ".out", ".html", ".json", ".csv", ".ini", ".svg", ".h", ".txt"):
        return byte_difference(*contents)
    texts = [without_builds(content.decode(errors="replace"), build) for content, build in zip(contents, builds)]
    if old.suffix == ".json":
        return json_difference(*map(members, texts))
    return csv_difference(*texts, ignored) if old.suffix == ".csv" else text_difference(*texts, old.name)


def products(folder):
    """Files by their names, and folders that are tables, which stand for their own files."""
    found = {}
    for path in sorted(folder.rglob("*")):
        if path.is_symlink():
            continue
        if path.is_dir() and (path / "table.dat").exists():
            found[str(path.relative_to(folder))] = path
        elif path.is_file() and not (path.parent / "table.dat").exists():
            found[str(path.relative_to(folder))] = path
    return found


def told_first(name):
    """Sorts what says most to people to the front."""
    return [not name.endswith(end) for end in (".code", ".out", ".err", ".fits")] + [name]


def differences(old, new, builds, ignored=frozenset(), uncompared="(?!)"):
    """(number of products, texts of what differs) of two folders; `ignored` columns of CSV files are not looked at, and of files
    whose names match `uncompared` nothing but that they are there."""
    of_old, of_new = products(old), products(new)
    found = [f"{name}: only {'OLD' if name in of_old else 'NEW'} leaves it" for name in sorted(of_old.keys() ^ of_new.keys())]
    for name in sorted(of_old.keys() & of_new.keys(), key=told_first):
        if re.fullmatch(uncompared, name):
            continue
        a, b = of_old[name], of_new[name]
        try:
            if a.is_dir() != b.is_dir():
                difference = "a table / a file"
            else:
                difference = table_difference(a, b, builds) if a.is_dir() else file_difference(a, b, builds, ignored)
        except (ValueError, LookupError, RuntimeError) as error:  # of numpy, json and casacore
            difference = f"differs, and one of the two cannot be read: {error}"
        if difference:
            found.append(f"{name}, {difference}")
    return len(of_old), found
