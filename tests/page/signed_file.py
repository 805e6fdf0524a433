"""Compares the numbers, days and words of pages with the signed file that they show.

usage: signed_file.py PAGES.json NAME PASSPORT.yaml   prints what is wrong, a line each; nothing when all is well.

The file is read by PyYAML, and numbers are rounded by `decimal`: nothing here knows how the program does either.
"""

import json
import math
import re
import sys
from decimal import ROUND_HALF_EVEN, Decimal

import yaml

NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
# Degrees, if there are any, minutes and seconds.
ANGLE = re.compile(r"(-?)(?:(\d+)°)?(\d\d?)′(\d\d(?:\.\d+)?)")
SUPERSCRIPTS = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")


def leaves(node):
    """Every number and every string of a document."""
    if isinstance(node, dict):
        for value in node.values():
            yield from leaves(value)
    elif isinstance(node, list):
        for value in node:
            yield from leaves(value)
    else:
        yield node


def printed(text, comma):
    """A printed number as a Decimal, and the place of its last digit; a picture's number may have its unit."""
    plain = text.partition("\u00a0")[0].removesuffix("°").replace("\u202f", "").replace("\u2212", "-")
    mark, other = (",", ".") if comma else (".", ",")
    if other in plain:
        raise ValueError(f"{text!r} has the decimal mark of another language")
    angle = ANGLE.fullmatch(plain.replace(mark, "."))
    if angle:
        sign, degrees, minutes, seconds = angle.groups()
        if not 10 * (60 if degrees is None else 0) <= 60 * int(minutes) < 3600 or Decimal(seconds) >= 60:
            raise ValueError(f"{text!r} is no angle above 600 arcseconds")
        number = 3600 * int(degrees or 0) + 60 * int(minutes) + Decimal(seconds)
        return -number if sign else number, Decimal(seconds).as_tuple().exponent
    # The sign before a power of ten is a cross in English, a point in Russian.
    mantissa, _, power = plain.replace(mark, ".").partition("·10" if comma else "×10")
    number = Decimal(mantissa)
    exponent = int(power.translate(SUPERSCRIPTS)) if power else 0
    return number.scaleb(exponent), number.as_tuple().exponent + exponent


def derived(content):
    """Uncertainties that are not in the file: of the astronomic latitude, and, propagated, of the components of the Earth rate."""
    site, earth = content["site"], content["earth"]
    latitude = (site.get("uncertainty") or {}).get("latitude_arcsec", 0)
    deflection = 0
    if "latitude_deg" in site:
        # An unknown deflection is taken as 0 with u = 10 arcseconds, as the file says.
        deflection = (site.get("deflection_arcsec") or {"u": 10}).get("u", 0)
    arcsec = math.hypot(latitude, deflection)
    u = math.radians(arcsec / 3600)
    return [arcsec, *(abs(earth[f"{other}_deg_per_h"]) * u for other in ("vertical", "horizontal"))]


def expanded(content):
    """U = 2u of every certified value, from its own part and both common parts: rotations about the axes, of which alpha and gamma
    take the part that the angle beta leaves them."""
    certificate = content["certificate"]
    common = [certificate.get(f"common_{part}_arcsec") for part in ("platform", "base")]
    found = []
    for at in content["positions"]:
        for angle in ("alpha", "beta", "gamma"):
            own = at.get(f"u_{angle}_arcsec")
            if own is None or None in common:
                continue
            share = 1 if angle == "beta" else math.cos(math.radians(at["beta_arcsec"] / 3600))
            found.append(2 * math.sqrt(own**2 + sum((u / share) ** 2 for u in common)))
    return found


def of_the_mark(content):
    """Coordinates that only the azimuth mark has, and the place of the second digit of their uncertainty."""
    mark = content["site"].get("azimuth_mark") or {}
    u = mark.get("position_u_m")
    if not u:
        return {}
    along = math.cos(math.radians(mark["latitude_deg"]))
    place = lambda metres: math.floor(math.log10(metres / 111e3)) - 1
    return {mark["latitude_deg"]: place(u), mark["longitude_deg"]: place(u / along)}


def main():
    pages, name, file = sys.argv[1:]
    said = json.load(open(pages, encoding="utf-8"))[name]["said"]
    text = open(file, encoding="utf-8", newline="").read()
    content = yaml.load(text, Loader=yaml.CSafeLoader)
    values = list(leaves(content))
    floats = {float(value) for value in values if isinstance(value, (int, float)) and not isinstance(value, bool)}
    # What comments say in numbers is signed too.
    comments = " ".join(line for line in text.splitlines() if line.lstrip().startswith("#"))
    in_comments = {Decimal(number) for number in NUMBER.findall(comments)}
    strings = {str(value) for value in values}
    wrong = []

    if len(said["numbers"]) < 40:
        wrong.append(f"only {len(said['numbers'])} numbers on the page")
    for number in said["numbers"]:
        value, shown = number["value"], number["text"]
        digits, place = printed(shown, number["lang"] == "ru")
        digits = -digits if number["negative"] else digits
        if Decimal(value) in in_comments or digits in in_comments:
            continue
        if any(math.isclose(float(value), u, rel_tol=1e-12) for u in derived(content) + expanded(content)):
            floats.add(float(value))
        if float(value) not in floats:
            wrong.append(f"{value} is on the page and not in the file")
        elif digits != Decimal(float(value)).quantize(Decimal(1).scaleb(place), ROUND_HALF_EVEN) and float(digits) != float(value):
            wrong.append(f"{shown} is not {value} rounded")

    on_the_page = [float(number["value"]) for number in said["numbers"]]
    for u in expanded(content):
        if not any(math.isclose(value, u, rel_tol=1e-12) for value in on_the_page):
            wrong.append(f"the expanded uncertainty {u} is not on the page")
    latitude_u, *_ = derived(content)
    if latitude_u and not any(math.isclose(float(number["value"]), latitude_u, rel_tol=1e-12) for number in said["numbers"]):
        wrong.append(f"the uncertainty of the astronomic latitude, {latitude_u}, is not on the page")
    for value, due in of_the_mark(content).items():
        places = [printed(number["text"], number["lang"] == "ru")[1] for number in said["numbers"] if float(number["value"]) == abs(value)]
        if due not in places:
            wrong.append(f"{value} has the last place {places}, and its uncertainty {due}")

    for day in said["days"]:
        year, month, date = day["value"][:10].split("-")
        if said["lang"] == "ru" and not said["both"]:
            due = f"{date}.{month}.{year}"
        else:
            due = f"{year}-{month}-{date}"
        if day["value"] not in strings:
            wrong.append(f"the day {day['value']} is not in the file")
        if not day["text"].startswith(due) or (len(day["value"]) > 10 and day["value"][11:19] not in day["text"]):
            wrong.append(f"{day['text']} is not {day['value']}")

    for words in said["given"]:
        if words not in strings:
            wrong.append(f"{words!r} is not in the file")

    # Everything that the file says in words is on the page outside the annex, too.
    shown = set(said["given"]) | set(said["codes"]) | {day["value"] for day in said["days"]} | {said["annex"]}
    for section in ("passport", "stand", "certificate", "datum", "site", "accuracy"):
        stated = dict(content.get(section) or {})
        # What a line of type B acts on is a word of the page's own language.
        stated["type_b"] = [{**line, "acts_on": None} for line in stated.get("type_b") or []]
        for value in leaves(stated):
            if isinstance(value, str) and value not in shown:
                wrong.append(f"{section}: {value!r} is in the file and not on the page")

    if said["annex"] != text:
        wrong.append("the annex is not the file")
    print("\n".join(wrong))


if __name__ == "__main__":
    main()
