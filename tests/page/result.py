"""Compares the numbers of a report with the result of the same calibration, as `--format json` writes it, and with the files that
went into it, which
are those of `calibrate`'s arguments.

usage: result.py PAGES.json NAME RESULT.json ASKED...   prints what is wrong, a line each; nothing when all is well.

Files are read by PyYAML and csv, numbers are rounded by `decimal`: nothing here knows how the program does either.
"""

import csv
import json
import math
import re
import sys
from datetime import datetime, timezone
from decimal import ROUND_FLOOR, ROUND_HALF_EVEN, Decimal

import yaml

from signed_file import leaves, printed

# A number as pages write it, angles with degrees and minutes too.
TOKEN = re.compile(
    r"(?<![\w.,−-])[−-]?(?:(?:\d+°)?\d\d?′)?\d(?:[\d\u202f]*\d)?(?:[.,]\d(?:[\d\u202f]*\d)?)?(?:\u202f?[·×]\u202f?10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?(?!\w)"
)
DAY = re.compile(r"\d{4}-\d\d-\d\d|\d\d\.\d\d\.\d{4}")
# What is no number of the result: clauses of standards, coverage, the sum's name, ids, times of day, the limit of risks,
# the greatest of the heights that are as probable if none is stated.
NAMES = re.compile(
    r"JCGM[\u00a0 ]\d+, [\d.]+|k[\u00a0 ]=[\u00a0 ]1\b|^[\u00a0 ]=[\u00a0 ]1[.,]96\b|95(?:[.,]45)?[\u00a0 ]?%|SHA-256|[A-Z]+-\d+(?:/\w+/[\w-]+/\d+)?|\d\d:\d\d:\d\d|< 1\u202f[·×]\u202f10⁻⁶|4000\u00a0[mм]\b|> 1000"
)
# The eight of every table of parameters, by their symbols.
PLACES = {
    "Kx": ("k_deg_per_h_per_ma", 0, 0),
    "Kxy": ("k_deg_per_h_per_ma", 0, 1),
    "Kyx": ("k_deg_per_h_per_ma", 1, 0),
    "Ky": ("k_deg_per_h_per_ma", 1, 1),
    "ω0x": ("omega0_deg_per_h", 0),
    "ω0y": ("omega0_deg_per_h", 1),
    "ωg": ("omega_g_deg_per_h_per_g",),
    "ωk": ("omega_k_deg_per_h_per_g",),
}
METHODS = {
    "least-squares": ("weighted least squares", "взвешенный мнк"),
    "analytic": ("analytic", "аналитический"),
    "iterative": ("iterative", "итерационный"),
}


def numbers(node, path=()):
    """Every number of a document with the path to it."""
    if isinstance(node, dict):
        for key, value in node.items():
            yield from numbers(value, (*path, key))
    elif isinstance(node, list):
        for index, value in enumerate(node):
            yield from numbers(value, (*path, index))
    elif isinstance(node, (int, float)) and not isinstance(node, bool):
        yield path, float(node)


def at(node, path):
    """What stands at a path; None where nothing does."""
    for key in path:
        try:
            node = node[key]
        except (KeyError, IndexError, TypeError):
            return None
    return node


def uncertainty(result, path):
    """The uncertainty that says how many digits the number at a path has; None where it has none."""
    *head, last = path
    if path[0].startswith("gravity"):
        return result.get("gravity_u_m_per_s2")
    if "standard_uncertainty" in path or last in ("u_x", "u_y"):
        return at(result, path)
    if path[0] == "results" and last in ("x", "y"):
        return at(result, (*head, f"u_{last}"))
    if path[0] == "results":
        return at(result, (*path[:2], "standard_uncertainty", *path[2:]))
    if path[0] in ("verdict", "change") and last in ("deviation", "expanded_uncertainty"):
        return at(result, (*head, "expanded_uncertainty"))
    if path[0] == "budget" and last == "value":
        return at(result, (*head, "standard_uncertainty"))
    if path[0] == "budget" and last == "expanded_uncertainty":
        return at(result, path)
    if path[0] == "budget" and last == "contribution":
        # The digits of the combined uncertainty of the parameter, whatever its own size.
        return at(result, (*path[:3], "standard_uncertainty"))
    if path[0] == "monte_carlo" and (last == "mean" or "symmetric_interval" in path):
        return at(result, (*path[:3], "standard_uncertainty"))
    return None


def symbol_of(key):
    """A parameter's symbol as text, by its key in lists: k_xy is Kxy, omega_0x is ω0x."""
    return "K" + key[2:] if key.startswith("k_") else key.replace("omega_", "ω")


def place_of(u):
    """The place of the second significant digit of an uncertainty (JCGM 100, 7.2.6)."""
    return int(f"{u:.1e}".partition("e")[2]) - 1


def rounded(value, place):
    return Decimal(value).quantize(Decimal(1).scaleb(place), ROUND_HALF_EVEN)


def derived(budget):
    """What words on a budget say besides: uncertainties of inputs, shares in percent, uncertainties of scale factors in percent of the factor, what
    would be left without the largest contribution, and how small its input would have to be to halve the whole."""
    for line in budget["parameters"] if budget else ():
        u, first = line["standard_uncertainty"], line["contributions"][0]
        rest = max(u**2 - first["contribution"] ** 2, 0) ** 0.5
        factors = [1, 100 / abs(line["value"])] if line["parameter"].startswith("k_") else [1]
        yield 100 * first["share"]
        yield from (part["input_standard_uncertainty"] for part in line["contributions"])
        yield from (factor * value for factor in factors for value in (u, rest))
        if u**2 / 4 > rest**2:
            limit = first["input_standard_uncertainty"] * ((u**2 / 4 - rest**2) ** 0.5 / first["contribution"])
            place = place_of(limit)
            yield float(Decimal(limit).quantize(Decimal(1).scaleb(place), ROUND_FLOOR))


def adopted(result):
    """The result of least squares, or of the last method."""
    return next((one for one in result["results"] if one["method"] == "least-squares"), result["results"][-1])


def course(results, gravity):
    """The parameters of several results, and their standard uncertainties, each at one gravity: PLACES × results."""
    for place in PLACES.values():
        line = []
        for result in results:
            answer = adopted(result)
            value, u = at(answer, place), at(answer["standard_uncertainty"], place)
            if place[0] in ("omega_g_deg_per_h_per_g", "omega_k_deg_per_h_per_g"):
                local = result["gravity_m_per_s2"]
                u = gravity / local * math.hypot(u, value * result.get("gravity_u_m_per_s2", 0) / local)
                value *= gravity / local
            line.append((value, u))
        yield line


def expanded(result):
    """The expanded uncertainty of each parameter by its symbol: k = 2, or Student's t of the same coverage by the expansion of
    Abramowitz and Stegun (26.7.5), which leaves out less than 1e-12 from ten thousand degrees of freedom on."""
    answer = adopted(result)
    freedom = {symbol_of(key): value for key, value in result["degrees_of_freedom"].items()}
    found = {}
    for symbol, place in PLACES.items():
        inverse = 1 / freedom.get(symbol, math.inf)
        u = at(answer["standard_uncertainty"], place)
        if inverse > 1e-4:
            raise ValueError(f"{symbol} has too few degrees of freedom for the expansion")
        if u is not None:
            found[symbol] = u * (2 + (2**3 + 2) / 4 * inverse + (5 * 2**5 + 16 * 2**3 + 3 * 2) / 96 * inverse**2)
    return found


class Report:
    def __init__(self, said, result, files, days, earlier=(), gravity=None):
        self.said, self.result, self.days = said, result, days
        # With a single earlier result there is a table of changes alone.
        gravity = gravity or result["gravity_m_per_s2"]
        self.course = list(course([*earlier, result], gravity)) if len(earlier) > 1 else []
        self.converted = [number for line in self.course for value, u in line for number in (value, 2 * u)]
        self.alone = {} if result.get("verdict") else expanded(result)
        self.known = {}
        for path, value in numbers(result):
            # What is missing is stated as at most so much.
            size = abs(value) if any(str(key).startswith("remainder") for key in path) else value
            self.known.setdefault(size, []).append(path)
        for part in ("verdict", "change"):
            lines = (result.get(part) or {}).get("parameters", [])
            # Expanded uncertainties of the values, and how many of how many pass.
            for line in lines:
                self.known.setdefault(line["coverage_factor"] * line["standard_uncertainty"], []).append(())
            for rule in ("guarded", "simple"):
                self.known.setdefault(sum(line[rule] == "pass" for line in lines), []).append(())
            self.known.setdefault(len(lines), []).append(())
        for value in files:
            self.known.setdefault(value, []).append(())
        self.derived = list(derived(result.get("budget")))
        # Of the standard uncertainties at the g of the type: the part of local g, and the whole.
        self.of_gravity, self.at_type = {}, {}
        for line in (result.get("verdict") or {}).get("parameters", []):
            symbol, from_gravity = symbol_of(line["parameter"]), line.get("expanded_uncertainty_from_gravity")
            self.at_type[symbol] = line["standard_uncertainty"]
            if from_gravity:
                self.of_gravity[symbol] = from_gravity / line["coverage_factor"]
                self.known.setdefault(self.of_gravity[symbol], []).append(())
                self.derived.append(result["gravity_u_m_per_s2"])
        # What may be wrong stands in the result in words: its numbers, and half of their last places.
        causes = " ".join(cause["words"] for cause in result.get("causes", ()))
        hinted = (printed(number, False) for number in TOKEN.findall(causes.replace("-", "−")))
        self.hinted = [(number, Decimal("0.5").scaleb(place)) for number, place in hinted]
        self.wrong = []

    def number(self, value, shown, lang):
        """A number that is marked as such: known, rounded once, to its uncertainty's digits."""
        digits, place = printed(shown, lang == "ru")
        paths = self.known.get(float(value))
        if paths is None and any(math.isclose(float(value), other, rel_tol=1e-14) for other in self.converted):
            paths = [()]
        if paths is None and any(math.isclose(float(value), other, rel_tol=1e-12) for other in self.alone.values()):
            paths = [()]
        if paths is None:
            self.wrong.append(f"{value} is on the page and not in the result")
            return
        if digits != rounded(float(value), place) and float(digits) != float(value):
            self.wrong.append(f"{shown} is not {value} rounded")
        # Contributions have one digit more than the uncertainty, so that their squares add up.
        due = [(uncertainty(self.result, path) if path else None, int("contribution" in path)) for path in paths]
        alone = adopted(self.result)
        due += [(u, 0) for symbol, u in self.alone.items() if at(alone, PLACES[symbol]) == float(value)]
        if all(u and place_of(u) - more != place for u, more in due):
            self.wrong.append(f"{shown} has not the digits of its uncertainty {due[0][0]}: {paths[0]}")

    def sentence(self, words):
        """The numbers within a sentence: each one that of the result, rounded, whatever its sign."""
        for day in DAY.findall(words["text"]):
            self.day(day)
        for shown in TOKEN.findall(NAMES.sub(" ", DAY.sub(" ", words["text"]))):
            digits, place = printed(shown, words["lang"] == "ru")
            # A budget's words name its inputs, and what it comes to.
            near = self.derived if words["section"] == "budget" else [*self.known, *self.derived]
            near = [abs(value) for value in near]
            # What may be wrong is told with two digits, so with zeros at the end of large numbers.
            half = Decimal("0.5").scaleb(max(place, digits.adjusted() - 1))
            hinted = any(abs(number - digits) <= half + other for number, other in self.hinted)
            if not hinted and all(rounded(value, place) != abs(digits) for value in near):
                self.wrong.append(f"{shown} of {words['text']!r} is not in the result")

    def day(self, day):
        date = "-".join(reversed(day.split("."))) if "." in day else day
        if date not in self.days:
            self.wrong.append(f"the day {day} is in no file, and was not asked for")

    def tables(self):
        found = [self.table(table) for table in self.said["tables"]]
        # The usual report has what the decision rests on; the rest has details.
        due = set() if self.usual else {"parameters", "residuals"}
        due |= {*(part for part in ("verdict", "change") if self.result.get(part))}
        due |= {"course"} if self.course else set()
        due |= {"alone"} if self.alone else set()
        if not due <= set(found):
            self.wrong.append(f"tables are missing: {found}")

    def table(self, table):
        """Cells by the names of their rows and columns."""
        heads = [head.split(",")[0].strip() for head in table["heads"]]
        if set(heads[1:]) == set(PLACES):
            return self.parameters(heads, table)
        if heads[:2] == ["i", "j"]:
            return self.residuals(table)
        if self.alone and heads[1:] in (["Value", "± U"], ["Значение", "± U"]):
            return self.values(table)
        if len(heads) in (9, 10):
            return self.verdict(table)
        if heads[1:2] in (["Calibration"], ["Калибровка"]):
            return self.of_course(table)
        return table["caption"]

    def cell(self, what, cell, due, u=None):
        """One cell: the number that is due there, with the digits of its uncertainty."""
        shown = [float(value) for value in cell["values"]]
        if due is None and shown or due is not None and shown != [due]:
            self.wrong.append(f"{what}: {cell['text']} {shown}, and in the result {due}")
        elif u and printed(cell["text"], self.said["lang"] == "ru")[1] != place_of(u):
            self.wrong.append(f"{what}: {cell['text']} has not the digits of its uncertainty {u}")

    def parameters(self, heads, table):
        names = [row[0]["text"].lower() for row in table["rows"]]
        if any(name.startswith(("combined", "суммарная", "mean", "среднее")) for name in names):
            return self.of_uncertainty(heads, table)
        method = None
        for row in table["rows"]:
            name = row[0]["text"].lower()
            for index, result in enumerate(self.result["results"]):
                if name.startswith(METHODS[result["method"]]):
                    method, kind = index, ()
            if name == "u":
                kind = ("standard_uncertainty",)
            if name.startswith(("difference", "отличие")):
                kind = None
            for symbol, cell in zip(heads[1:], row[1:]):
                if kind is None:
                    order = ["Kx", "Kxy", "Kyx", "Ky", "ω0x", "ω0y", "ωg", "ωk"]
                    path, u = ("results", method, "from_least_squares", order.index(symbol)), None
                else:
                    path = ("results", method, *kind, *PLACES[symbol])
                    u = uncertainty(self.result, path)
                self.cell(f"{name}, {symbol}", cell, at(self.result, path), u)
        return "parameters"

    def of_uncertainty(self, heads, table):
        """Of a budget or a Monte Carlo, whose parameters stand in a list."""
        part = "monte_carlo" if table["rows"][0][0]["text"].lower().startswith(("mean", "среднее")) else "budget"
        keys = {
            "u": ("standard_uncertainty",),
            "combined": ("standard_uncertainty",),
            "суммарная": ("standard_uncertainty",),
            "half-width": ("expanded_uncertainty",),
            "полуширина": ("expanded_uncertainty",),
            "mean": ("mean",),
            "среднее": ("mean",),
            "lower": ("symmetric_interval", 0),
            "нижняя": ("symmetric_interval", 0),
            "upper": ("symmetric_interval", 1),
            "верхняя": ("symmetric_interval", 1),
        }
        lines = {symbol_of(line["parameter"]): line for line in self.result[part]["parameters"]}
        gravity = []
        for row in table["rows"]:
            name = row[0]["text"].lower().replace("\xa0", " ")
            if part == "budget" and name.startswith(("conversion to g", "пересчёт к g", "combined u, for", "суммарная u, для")):
                gravity.append(self.at_gravity(name, heads, row, lines))
                continue
            key = next((keys[word] for word in keys if row[0]["text"].lower().replace(",", "").split(" ")[0] == word), None)
            for symbol, cell in zip(heads[1:], row[1:]):
                line = lines[symbol]
                if key:
                    u = line["expanded_uncertainty" if key[0] == "expanded_uncertainty" else "standard_uncertainty"]
                    self.cell(f"{row[0]['text']}, {symbol}", cell, at(line, key), u)
                elif part == "budget" and cell["text"] == "> 1000":
                    if not 1000 <= line["effective_degrees_of_freedom"] <= 1e4:
                        self.wrong.append(f"{symbol}: {line['effective_degrees_of_freedom']} degrees of freedom are not > 1000")
                elif part == "budget" and cell["values"]:
                    known = [one["contribution"] for one in line["contributions"]] + [line.get("effective_degrees_of_freedom")]
                    if float(cell["values"][0]) not in known:
                        self.wrong.append(f"{row[0]['text']}, {symbol}: {cell['text']} is no contribution to it")
                    if not printed(cell["text"], self.said["lang"] == "ru")[0]:
                        self.wrong.append(f"{row[0]['text']}, {symbol}: {cell['text']} is rounding noise")
        if part == "budget":
            self.left_out(heads, table, lines)
            if gravity != (["part", "whole"] if self.of_gravity else []):
                self.wrong.append(f"the rows of local g are {gravity}")
        return part

    def at_gravity(self, name, heads, row, lines):
        """What the local g adds to the decision, and what the uncertainty then is: their squares add up with those above."""
        kind = "part" if name.startswith(("conversion", "пересчёт")) else "whole"
        for symbol, cell in zip(heads[1:], row[1:]):
            due, whole = (self.of_gravity if kind == "part" else self.at_type).get(symbol), self.at_type[symbol]
            # A contribution has one digit more than the whole.
            self.cell(f"{name}, {symbol}", cell, due, whole if kind == "whole" else None)
            if kind == "part" and due and printed(cell["text"], self.said["lang"] == "ru")[1] != place_of(whole) - 1:
                self.wrong.append(f"{name}, {symbol}: {cell['text']} has not one digit more than {whole}")
            part = self.of_gravity.get(symbol, 0)
            ratio = self.result["verdict"]["gravity_m_per_s2"] / self.result["gravity_m_per_s2"] if part else 1
            sum_of_squares = math.hypot(ratio * lines[symbol]["standard_uncertainty"], part)
            if not math.isclose(sum_of_squares, whole, rel_tol=1e-9):
                self.wrong.append(f"{name}, {symbol}: {sum_of_squares} at local g, and {whole} in the decision")
        return kind

    def left_out(self, heads, table, lines):
        """A dash is a contribution that rounds to zero; one below a thousandth of every variance has no row."""
        for column, symbol in enumerate(heads[1:], 1):
            shown = {float(value) for row in table["rows"] for value in row[column]["values"]}
            u = lines[symbol]["standard_uncertainty"]
            for part in lines[symbol]["contributions"]:
                due = part["share"] >= 1e-3 and rounded(part["contribution"], place_of(u) - 1)
                if due and part["contribution"] not in shown:
                    self.wrong.append(f"{symbol}: the contribution {part} is not on the page")

    def values(self, table):
        """The parameters without a type."""
        answer = adopted(self.result)
        symbols = [row[0]["text"].split(",")[0] for row in table["rows"]]
        if sorted(symbols) != sorted(self.alone):
            self.wrong.append(f"the result has other parameters: {symbols}")
        for symbol, row in zip(symbols, table["rows"]):
            u = self.alone[symbol]
            self.cell(f"{symbol}, value", row[1], at(answer, PLACES[symbol]), u)
            shown = [float(value) for value in row[2]["values"]]
            if len(shown) != 1 or not math.isclose(shown[0], u, rel_tol=1e-12):
                self.wrong.append(f"{symbol}: U is {shown}, and that of its result {u}")
        return "alone"

    def residuals(self, table):
        due = adopted(self.result)["residuals_deg_per_h"]
        if len(table["rows"]) != len(due):
            self.wrong.append(f"{len(table['rows'])} rows of residuals, and {len(due)} in the result")
        for row, line in zip(table["rows"], due):
            if [row[0]["text"], row[1]["text"]] != [str(line["i"]), str(line["j"])]:
                self.wrong.append(f"a row of residuals is out of order: {row}")
            for key, cell in zip(("x", "u_x", "y", "u_y"), [*row[2:4], *row[5:7]]):
                self.cell(f"residual {key} of ({line['i']}, {line['j']})", cell, line[key], line[f"u_{key[-1]}"])
        return "residuals"

    def of_course(self, table):
        """Every parameter from the earliest calibration to this one."""
        due = [(symbol, *pair) for symbol, line in zip(PLACES, self.course) for pair in line]
        by_symbol = {}
        for row in table["rows"]:
            by_symbol.setdefault(row[0]["text"].split(",")[0], []).append(row)
        rows = [row for symbol in PLACES for row in by_symbol.get(symbol, [])]
        for (symbol, value, u), row in zip(due, rows, strict=True):
            for cell, number in ((row[2], value), (row[3], 2 * u)):
                shown = [float(one) for one in cell["values"]]
                if len(shown) != 1 or not math.isclose(shown[0], number, rel_tol=1e-14):
                    self.wrong.append(f"{symbol}, {row[1]['text']}: {cell['text']} {shown}, and in its result {number}")
                elif printed(cell["text"], self.said["lang"] == "ru")[1] != place_of(2 * u):
                    self.wrong.append(f"{symbol}, {row[1]['text']}: {cell['text']} has not the digits of its uncertainty {u}")
        return "course"

    def verdict(self, table):
        part = "change" if any(head.startswith(("Change", "Изменение")) for head in table["heads"]) else "verdict"
        # Each of the two U is below the heading that says in which unit it is.
        due = {"± U": ["parameter", "tolerance"][2 - table["heads"].count("± U") :]}
        russian = {"parameter": "параметра", "tolerance": "допуска"}
        for head, group in zip(table["heads"], table["groups"], strict=True):
            if head == "± U":
                unit = due[head].pop(0)
                if unit not in group and russian[unit] not in group:
                    self.wrong.append(f"{part}: ± U below {group!r}, and its unit is that of the {unit}")
        for row, line in zip(table["rows"], self.as_printed(part), strict=True):
            # The decision stands beside the name, for telephones.
            near, name = row[0]["text"].split(",")[0].split("\u00a0")
            # A drift at the g of the type has another unit than one at local g.
            if "·g" in row[0]["text"] and "·g0" not in row[0]["text"]:
                self.wrong.append(f"{part}: the unit of {row[0]['text']} is that of a drift at local g")
            if name != symbol_of(line["parameter"]):
                self.wrong.append(f"{part}: {name} stands in the row of {line['parameter']}")
            u = line["coverage_factor"] * line["standard_uncertainty"]
            self.cell(f"{part}, {name}, value", row[1], line["value"], u)
            # The uncertainty of a change is not that of the value, which stands in the verdict.
            if part == "verdict":
                self.cell(f"{part}, {name}, U of the value", row[2], u, u)
                row = row[:2] + row[3:]
            self.cell(f"{part}, {name}, reference", row[2], line["reference_value"], u)
            u = line["expanded_uncertainty"]
            self.cell(f"{part}, {name}, deviation", row[3], line["deviation"], u)
            self.cell(f"{part}, {name}, U", row[4], line["expanded_uncertainty"], u)
            self.cell(f"{part}, {name}, tolerance", row[5], line["tolerance"])
            marks = {"pass": "●", "undecided": "◐", "fail": "✕"}
            if not self.stated():
                marks = dict.fromkeys(marks, "○")
            if near != marks[line["decision"]]:
                self.wrong.append(f"{part}, {name}: {near} beside the name, and {line['decision']} in the result")
            if not row[7]["text"].startswith(marks[line["decision"]]):
                self.wrong.append(f"{part}, {name}: {row[7]['text']}, and {line['decision']} in the result")
            # Without a decision there is no risk.
            if "specific_risk" not in line:
                if row[8]["text"] != "–":
                    self.wrong.append(f"{part}, {name}: risk {row[8]['text']} without a decision")
                continue
            if row[8]["values"]:
                self.cell(f"{part}, {name}, risk", row[8], line["specific_risk"])
            elif "<" not in row[8]["text"] or line["specific_risk"] >= 1e-6:
                self.wrong.append(f"{part}, {name}: risk {row[8]['text']}, and {line['specific_risk']} in the result")
        self.simple(part)
        return part

    def stated(self):
        """No statement is made on parameters that are not valid, or that rest on a passport that was not verified."""
        return self.result["consistent"] and "mistake" not in self.result and self.result["passport_verified"]

    def not_in_u(self):
        """The number of inputs without a stated uncertainty stands beside the verdict, if there is one."""
        missing = len(self.result.get("not_stated", []))
        if missing and (self.stated() or "verdict" not in self.result):
            said = " ".join(self.said["verdicts"]).replace("\u00a0", " ")
            due = {"en": f"stated as 0): {missing} (", "ru": f"не указана или равна 0): {missing} ("}
            if due[self.said["lang"]] not in said:
                self.wrong.append(f"{missing} inputs are not in U, and the verdict says {said!r}")

    def as_printed(self, part):
        """The parameters of a verdict in the paper's order, which pages have."""
        order = ["k_x", "k_y", "k_xy", "k_yx"]
        return sorted(self.result[part]["parameters"], key=lambda line: (order + [line["parameter"]]).index(line["parameter"]))

    def simple(self, part):
        """The sentence on simple acceptance below the table: how many pass, and the names of those that fail."""
        lines = self.as_printed(part)
        fails = ", ".join(symbol_of(line["parameter"]) for line in lines if line["simple"] == "fail")
        passed = sum(line["simple"] == "pass" for line in lines)
        due = {
            "en": f"without a guard band, {passed} of {len(lines)} parameters pass" + (f"; fail: {fails}." if fails else "."),
            "ru": f"без защитной полосы: соответствие допускам у {passed} из {len(lines)} параметров"
            + (f"; несоответствие: {fails}." if fails else "."),
        }
        said = "".join(words["text"] for words in self.said["words"]).replace("\u00a0", " ")
        shown = self.stated() and not self.usual and self.result[part]["rule"]["rule"] == "guarded"
        if shown != (due[self.said["lang"]] in said):
            self.wrong.append(f"{part}: {due[self.said['lang']]!r} is{'' if shown else ' not'} to be on the page")


def of_file(file):
    """The numbers of a file."""
    text = open(file, encoding="utf-8").read()
    if file.endswith(".csv"):
        rows = csv.reader(line for line in text.splitlines() if not line.startswith("#"))
        cells = [cell for row in rows for cell in row if re.fullmatch(r"-?[\d.]+", cell)]
        return [float(cell) for cell in cells]
    return [float(value) for value in leaves(yaml.load(text, Loader=yaml.CSafeLoader)) if isinstance(value, (int, float))]


def main():
    pages, name, result, *asked = sys.argv[1:]
    said = json.load(open(pages, encoding="utf-8"))[name]["said"]
    result = json.load(open(result, encoding="utf-8"))
    files = [word for word in asked if word.endswith((".yaml", ".csv", ".json"))]
    texts = [open(file, encoding="utf-8").read() for file in files]
    values = [value for file in files for value in of_file(file)]
    if "--laboratory" not in asked:
        # The paper's meter: ±0.015 % of a reading, uniform (JCGM 100, 4.3.7), with a floor of a nanoampere at a range of 1 mA.
        values += [0.015, round(0.015 / 3**0.5, 4), 0, 1e-6, 1]
    days = {day for text in [*texts, *asked] for day in DAY.findall(text)}
    if "--no-verify" in asked:
        # Then the day is that of the report.
        days.add(datetime.now(timezone.utc).date().isoformat())
    earlier = [json.load(open(file, encoding="utf-8")) for option, file in zip(asked, asked[1:]) if option == "--previous"]
    types = [yaml.safe_load(open(file, encoding="utf-8")) for option, file in zip(asked, asked[1:]) if option == "--gyro"]
    gravity = types[0].get("gravity_m_per_s2", 9.80665) if types else None
    # Limits that sentences name: of the probability of chi-square, and of the differences between methods.
    values += [0.005, 3]
    report = Report(said, result, values, days, earlier, gravity)
    report.usual = "--details" not in asked
    if len(said["numbers"]) < 60:
        report.wrong.append(f"only {len(said['numbers'])} numbers on the page")
    for number in said["numbers"]:
        report.number(number["value"], number["text"], number["lang"])
    for day in said["days"]:
        report.day(day["value"][:10])
        report.day(DAY.findall(day["text"])[0])
    for words in said["words"]:
        if not words["drawn"]:
            report.sentence(words)
    report.tables()
    report.not_in_u()
    annex = json.loads(said["annex"])
    if annex != {key: value for key, value in result.items() if key not in ("budget", "monte_carlo")}:
        report.wrong.append("the annex is not the result")
    print("\n".join(report.wrong))


main()
