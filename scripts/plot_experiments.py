#!/usr/bin/env python3
"""Plots and tables of docs/convergence.md from the documents of `snug-research rates` and `snug-research tightness`.

usage: plot_experiments.py DOCUMENTS PAGE.md PICTURES
DOCUMENTS: a folder with rates.json, tightness.json, SCHEME.json of rates of schemes other than Loop, and SCHEME-PLACE.json of `rates --at PLACE`.
Writes PICTURES/rates.svg, factors.svg, schemes.svg, places.svg, semi_sharp.svg and tightness.svg, and puts the tables between the marks
`<!-- table: NAME -->` and `<!-- end -->` of the page. Plain SVG, no packages.
"""

import json
import math
import pathlib
import re
import sys

from svg_picture import BLACK, GREY, Picture

# One look for each source of bounds: colour-blind safe, and told apart by its mark as well.
SOURCES = {
    ("rows", None): ("hull rows", "#0072b2", "circle"),
    ("table", "ngon"): ("table, n-gon", "#d55e00", "square"),
    ("table", "characteristic"): ("table, characteristic", "#009e73", "triangle"),
}
SCHEMES = {"loop": "Loop", "catmark": "Catmull-Clark", "doo-sabin": "Doo-Sabin", "midedge": "Midedge"}
MEASURES = {("rows", "radius"): ("radius, hull rows", "#0072b2", "circle"),
            ("rows", "normal"): ("slab, hull rows", "#d55e00", "square"),
            ("table", "radius"): ("radius, table", "#009e73", "triangle")}
PLACES = ("boundary", "corner", "crease", "dart")
SHARPNESSES = {0.5: "#56b4e9", 1.5: "#009e73", 2.5: "#e69f00", 4.5: "#d55e00", None: "#222222"}
PANELS = (3, 5, 6, 8, 12, 50)


def source(row):
    return row["bounds"], row["layout"]


class Axes:
    """A frame of a picture. `x` and `y` are (low, high); y may be logarithmic."""

    def __init__(self, picture, box, x, y, logarithmic):
        self.picture, self.box, self.x, self.y, self.logarithmic = picture, box, x, y, logarithmic
        left, top, width, height = box
        picture.parts.append(f'<rect x="{left}" y="{top}" width="{width}" height="{height}" fill="none" '
                             f'stroke="{BLACK}"/>')

    def at(self, x, y):
        left, top, width, height = self.box
        low, high, value = (math.log10(v) for v in (*self.y, y)) if self.logarithmic else (*self.y, y)
        return (left + width * (x - self.x[0]) / (self.x[1] - self.x[0]),
                top + height * (1 - (value - low) / (high - low)))

    def ticks_x(self, ticks):
        for value, words in ticks:
            x, bottom = self.at(value, self.y[0])
            self.picture.line(x, bottom, x, bottom + 4)
            self.picture.text(x, bottom + 17, words, "middle")

    def ticks_y(self, ticks, labels=True):
        for value, words in ticks:
            left, y = self.at(self.x[0], value)
            right, _ = self.at(self.x[1], value)
            self.picture.line(left, y, right, y, "#dddddd", 0.8)
            self.picture.line(left - 4, y, left, y)
            if labels:
                self.picture.text(left - 7, y + 4, words, "end")

    def title(self, words):
        left, top, width, _ = self.box
        self.picture.text(left + width / 2, top - 7, words, "middle", bold=True)

    def label_x(self, words):
        left, top, width, height = self.box
        self.picture.text(left + width / 2, top + height + 35, words, "middle")

    def label_y(self, words, distance=48):
        left, top, _, height = self.box
        self.picture.text(left - distance, top + height / 2, words, "middle", turned=True)


def power(exponent):
    return f'10<tspan dy="-5" font-size="9">{str(exponent).replace("-", chr(0x2212))}</tspan>'


def legend(picture, x, y, entries, step):
    for i, (draw, words) in enumerate(entries):
        draw(x + i * step, y)
        picture.text(x + i * step + 32, y + 4, words)


def source_entry(picture, key, dash=None, hollow=False):
    _, colour, shape = SOURCES[key]

    def draw(x, y):
        picture.line(x, y, x + 26, y, colour, 1.5, dash)
        picture.mark(shape, x + 13, y, colour, hollow=hollow)
    return draw


def plain_entry(picture, dash, colour=GREY):
    return lambda x, y: picture.line(x, y, x + 26, y, colour, 1.3, dash)


def plot_rates(rows, path):
    picture = Picture(940, 720, "Radius at an extraordinary corner, level by level")
    levels = max(len(row["thickness"]) for row in rows) - 1
    low, high = -9, 0
    for i, valence in enumerate(PANELS):
        box = (75 + 290 * (i % 3), 75 + 320 * (i // 3), 260, 255)
        axes = Axes(picture, box, (0, levels), (10.0 ** low, 10.0 ** high), True)
        axes.ticks_y([(10.0 ** e, power(e)) for e in range(low, high + 1)], i % 3 == 0)
        axes.ticks_x([(k, str(k)) for k in range(0, levels + 1, 2)])
        axes.title(f"valence {valence}" + (" (regular)" if valence == 6 else ""))
        mine = [row for row in rows if row["valence"] == valence]
        radii = {source(row): row for row in mine if row["measure"] == "radius"}
        across = next(row for row in mine if row["measure"] == "normal" and source(row) == ("rows", None))

        def clipped(values):
            return [axes.at(k, v) for k, v in enumerate(values) if v >= axes.y[0]]

        # Theory: through the last measured radius of each layout.
        for key, dash in ((("table", "ngon"), "7 4"), (("table", "characteristic"), "2 3")):
            row = radii[key]
            last = len(row["thickness"]) - 1
            picture.path(clipped([0.35 * row["thickness"][last] * row["expected"] ** (k - last)
                                  for k in range(last + 1)]), GREY, 1.3, dash)
        picture.path(clipped(across["thickness"]), SOURCES["rows", None][1], 1.2, "4 3")
        for x, y in clipped(across["thickness"]):
            picture.mark("circle", x, y, SOURCES["rows", None][1], 2.6, hollow=True)
        for key, (_, colour, shape) in SOURCES.items():
            points = clipped(radii[key]["thickness"])
            picture.path(points, colour)
            for x, y in points:
                picture.mark(shape, x, y, colour, 2.8)
        if i % 3 == 0:
            axes.label_y("thickness (spokes of length 1)")
        axes.label_x("level" if i >= 3 else "")
    legend(picture, 75, 20, [(source_entry(picture, key), f"radius, {SOURCES[key][0]}") for key in SOURCES], 275)
    picture_rows = [(source_entry(picture, ("rows", None), "4 3", True), "slab along the normal, hull rows"),
                    (plain_entry(picture, "7 4"), "slope of theory, n-gon"),
                    (plain_entry(picture, "2 3"), "slope of theory, characteristic")]
    legend(picture, 75, 42, picture_rows, 275)
    picture.save(path)


def plot_factors(rows, path):
    picture = Picture(940, 420, "Factor a level by which enclosures shrink, over the valence")
    valences = sorted({row["valence"] for row in rows})
    for i, (measure, title) in enumerate((("radius", "radius of the offset triangle"),
                                          ("normal", "slab along the limit normal"))):
        box = (75 + 450 * i, 75, 390, 285)
        axes = Axes(picture, box, (-0.5, len(valences) - 0.5), (0.1, 0.65), False)
        axes.ticks_y([(k / 10, f"{k / 10:.1f}") for k in range(1, 7)])
        axes.ticks_x([(k, str(v)) for k, v in enumerate(valences)])
        axes.title(title)
        axes.label_x("valence")
        first = {v: next(row for row in rows if row["valence"] == v) for v in valences}
        for field, dash in (("subdominant", "7 4"), ("next", "2 3")):
            picture.path([axes.at(k, first[v][field]) for k, v in enumerate(valences)], GREY, 1.3, dash)
        for s, (key, (_, colour, shape)) in enumerate(SOURCES.items()):
            for row in rows:
                if row["measure"] == measure and source(row) == key:
                    x, y = axes.at(valences.index(row["valence"]) + 0.17 * (s - 1), row["factor"])
                    picture.mark(shape, x, y, colour)
        if i == 0:
            axes.label_y("factor a level")
    entries = [((lambda x, y, key=key: picture.mark(SOURCES[key][2], x + 18, y, SOURCES[key][1])), SOURCES[key][0])
               for key in SOURCES]
    entries += [(plain_entry(picture, "7 4"), "subdominant"), (plain_entry(picture, "2 3"), "next eigenvalue")]
    legend(picture, 75, 25, entries, 172)
    picture.save(path)


def factor_panel(picture, box, rows, title, labels):
    """Measured factors of MEASURES over the faces in the middle, with two eigenvalues."""
    valences = sorted({row["valence"] for row in rows})
    axes = Axes(picture, box, (-0.5, len(valences) - 0.5), (0.1, 1), False)
    axes.ticks_y([(k / 10, f"{k / 10:.1f}") for k in range(1, 11)], labels)
    axes.ticks_x([(k, str(v)) for k, v in enumerate(valences)])
    axes.title(title)
    first = [next(row for row in rows if row["valence"] == v) for v in valences]
    for field, dash in (("subdominant", "7 4"), ("second", "3 3"), ("next", "1 3")):
        picture.path([axes.at(k, row[field]) for k, row in enumerate(first)], GREY, 1.3, dash)
    for s, (key, (_, colour, shape)) in enumerate(MEASURES.items()):
        for row in rows:
            if (row["bounds"], row["measure"]) == key:
                picture.mark(shape, *axes.at(valences.index(row["valence"]) + 0.22 * (s - 1), row["factor"]), colour, 2.8)
    if labels:
        axes.label_y("factor a level", 40)
    return axes


def factor_legend(picture):
    entries = [((lambda x, y, look=look: picture.mark(look[2], x + 18, y, look[1])), look[0])
               for look in MEASURES.values()]
    entries += [(plain_entry(picture, dash), words)
                for dash, words in (("7 4", "largest eigenvalue"), ("3 3", "second"), ("1 3", "third"))]
    legend(picture, 45, 25, entries, 155)


def plot_schemes(documents, path):
    picture = Picture(940, 420, "Factor a level by which enclosures shrink, over the valence, for three schemes")
    for i, rows in enumerate(documents):
        box = (65 + 295 * i, 75, 275, 285)
        factor_panel(picture, box, rows, SCHEMES[rows[0]["scheme"]], i == 0).label_x("valence")
    factor_legend(picture)
    picture.save(path)


def plot_places(documents, path):
    picture = Picture(940, 720, "Factor a level by which enclosures shrink at boundaries and creases, over the faces there")
    for k, scheme in enumerate(("loop", "catmark")):
        for i, place in enumerate(("boundary", "corner", "dart")):
            box = (65 + 295 * i, 75 + 320 * k, 275, 255)
            axes = factor_panel(picture, box, documents[scheme, place], f"{SCHEMES[scheme]}: {place}", i == 0)
            axes.label_x("faces" if k else "")
    factor_legend(picture)
    picture.save(path)


def plot_semi_sharp(documents, path):
    """Radius by level beside creases of several sharpnesses in a regular mesh; None: infinite."""
    picture = Picture(940, 420, "Radius beside a semi-sharp crease, level by level")
    for i, scheme in enumerate(("loop", "catmark")):
        regular = 6 if scheme == "loop" else 4
        axes = Axes(picture, (75 + 450 * i, 75, 390, 285), (0, 12), (1e-9, 1), True)
        axes.ticks_y([(10.0 ** e, power(e)) for e in range(-9, 1)], i == 0)
        axes.ticks_x([(k, str(k)) for k in range(0, 13, 2)])
        axes.title(SCHEMES[scheme])
        axes.label_x("level")
        rows = [row for row in documents[scheme, "semi-sharp"] + documents[scheme, "crease"]
                if row["bounds"] == "rows" and row["measure"] == "radius" and row["valence"] == regular]
        for row in rows:
            points = [axes.at(k, v) for k, v in enumerate(row["thickness"][:13])]
            picture.path(points, SHARPNESSES[row["sharpness"]], 1.5)
            for x, y in points:
                picture.mark("circle", x, y, SHARPNESSES[row["sharpness"]], 2.4)
        if i == 0:
            axes.label_y("radius (spokes of length 1)")
    entries = [(plain_entry(picture, None, colour), f"sharpness {s}" if s else "infinite") for s, colour in SHARPNESSES.items()]
    legend(picture, 75, 25, entries, 172)
    picture.save(path)


def plot_tightness(rows, path):
    picture = Picture(940, 420, "Radius over the least possible, by valence")
    valences = sorted({row["valence"] for row in rows})
    top = 10 ** math.ceil(math.log10(max(row["most"] for row in rows)))
    steps = [value * 10 ** e for e in range(3) for value in (1, 2, 5) if value * 10 ** e <= top]
    for i, shape in enumerate(("bent", "bumpy", "flat")):
        box = (65 + 295 * i, 75, 275, 285)
        axes = Axes(picture, box, (-0.5, len(valences) - 0.5), (0.9, top), True)
        axes.ticks_y([(s, str(s)) for s in steps], i == 0)
        axes.ticks_x([(k, str(v)) for k, v in enumerate(valences)])
        axes.title({"bent": "bent nets", "bumpy": "bumpy nets", "flat": "nearly flat nets"}[shape])
        axes.label_x("valence")
        for s, (key, (_, colour, mark)) in enumerate(SOURCES.items()):
            for row in rows:
                if row["shape"] != shape or source(row) != key or row["patches"] == 0:
                    continue
                k = valences.index(row["valence"]) + 0.26 * (s - 1)
                x, y = axes.at(k, row["median"])
                _, high = axes.at(k, row["high"])
                _, most = axes.at(k, row["most"])
                picture.line(x, y, x, most, colour, 0.8)
                picture.line(x, y, x, high, colour, 2.2)
                picture.line(x - 2.5, most, x + 2.5, most, colour, 0.8)
                picture.mark(mark, x, y, colour, 2.8)
        if i == 0:
            axes.label_y("radius / least radius", 40)
    legend(picture, 65, 25, [(source_entry(picture, key), SOURCES[key][0]) for key in SOURCES], 190)
    picture.text(645, 29, "mark: median, thick: to 95 %, thin: to the worst", size=11)
    picture.save(path)


def table(head, lines):
    return "\n".join(["| " + " | ".join(cells) + " |" for cells in (head, ["---"] * len(head), *lines)])


def factor_table(rows, measure):
    lines = []
    for valence in sorted({row["valence"] for row in rows}):
        mine = {source(row): row for row in rows if row["valence"] == valence and row["measure"] == measure}
        cells = [str(valence)]
        for key in SOURCES:
            cells += [f"{mine[key]['factor']:.3f}", f"{mine[key]['expected']:.3f}"]
        lines.append(cells)
    return table(["valence"] + [words for key in SOURCES for words in (SOURCES[key][0], "theory")], lines)


# Columns of a scheme: a heading, and what of (bounds, measure) it shows.
COLUMNS = (("rows: radius", ("rows", "radius"), "factor"), ("theory", ("rows", "radius"), "expected"),
           ("table: radius", ("table", "radius"), "factor"), ("theory", ("table", "radius"), "expected"),
           ("slab", ("rows", "normal"), "factor"), ("theory", ("rows", "normal"), "expected"))


def scheme_table(documents, first="valence"):
    """One document a scheme."""
    lines = []
    for valence in sorted({row["valence"] for row in documents[0]}):
        cells = [str(valence)]
        for rows in documents:
            mine = {(row["bounds"], row["measure"]): row for row in rows if row["valence"] == valence}
            cells += [f"{mine[key][field]:.3f}" if key in mine else "" for _, key, field in COLUMNS]
        lines.append(cells)
    head = [f"{SCHEMES[rows[0]['scheme']]}, {words}" if k == 0 else words
            for rows in documents for k, (words, _, _) in enumerate(COLUMNS)]
    return table([first] + head, lines)


def tightness_table(rows, shape):
    lines = []
    for valence in sorted({row["valence"] for row in rows}):
        mine = {source(row): row for row in rows if row["valence"] == valence and row["shape"] == shape}
        cells = [str(valence)]
        for key in SOURCES:
            cells += [f"{mine[key][field]:.3f}" if key[0] == "rows" else f"{mine[key][field]:.2f}"
                      for field in ("median", "high", "most")]
        cells += [f"{mine[key]['over_rows']:.2f}" for key in SOURCES if key[0] == "table"]
        lines.append(cells)
    head = ["valence"]
    for key in SOURCES:
        head += [f"{SOURCES[key][0]}: median", "95 %", "worst"]
    return table(head + ["n-gon over rows", "characteristic over rows"], lines)


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    folder, page, pictures = (pathlib.Path(name) for name in sys.argv[1:])

    def rows_of(name):
        return json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))["rows"]

    rates, tightness = rows_of("rates"), rows_of("tightness")
    schemes = [rows_of(name) for name in ("catmark", "doo-sabin", "midedge")]
    places = {(scheme, place): rows_of(f"{scheme}-{place}")
              for scheme in ("loop", "catmark") for place in (*PLACES, "semi-sharp")}
    plot_rates(rates, pictures / "rates.svg")
    plot_factors(rates, pictures / "factors.svg")
    plot_schemes(schemes, pictures / "schemes.svg")
    plot_places(places, pictures / "places.svg")
    plot_semi_sharp(places, pictures / "semi_sharp.svg")
    plot_tightness(tightness, pictures / "tightness.svg")
    tables = {f"factors {measure}": factor_table(rates, measure) for measure in ("radius", "interval", "normal")}
    tables |= {f"tightness {shape}": tightness_table(tightness, shape) for shape in ("bent", "bumpy", "flat")}
    tables["factors schemes"] = scheme_table(schemes)
    for place in PLACES:
        tables[f"factors {place}"] = scheme_table([places["loop", place], places["catmark", place]], "faces")
    text = page.read_text(encoding="utf-8")
    for name, lines in tables.items():
        mark = f"<!-- table: {name} -->"
        if mark not in text:
            sys.exit(f"{page}: no place for the table '{name}'")
        text = re.sub(re.escape(mark) + r".*?<!-- end -->", lambda _, new=f"{mark}\n\n{lines}\n\n<!-- end -->": new,
                      text, count=1, flags=re.DOTALL)
    page.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
