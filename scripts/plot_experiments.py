#!/usr/bin/python3
"""Plots and tables of docs/convergence.md from the documents of `snug-research rates` and `snug-research tightness`.

usage: plot_experiments.py DOCUMENTS PAGE.md PICTURES
DOCUMENTS: a folder with rates.json, tightness.json, SCHEME.json of rates of schemes other than Loop, and SCHEME-PLACE.json of `rates --at PLACE`.
Writes PICTURES/rates.svg, factors.svg, schemes.svg, places.svg, semi_sharp.svg and tightness.svg, and puts the tables between the marks
`<!-- table: NAME -->` and `<!-- end -->` of the page.
"""

import json
import math
import pathlib
import re
import sys

from plotting import GREY, panels, save

# One look for each source of bounds: colour-blind safe, and told apart by its mark as well.
SOURCES = {
    ("rows", None): ("bounding rows", "#0072b2", "o"),
    ("table", "ngon"): ("table, n-gon", "#d55e00", "s"),
    ("table", "characteristic"): ("table, characteristic", "#009e73", "^"),
}
SCHEMES = {"loop": "Loop", "catmark": "Catmull-Clark", "doo-sabin": "Doo-Sabin", "midedge": "Midedge"}
MEASURES = {("rows", "radius"): ("radius, bounding rows", "#0072b2", "o"),
            ("rows", "normal"): ("slab, bounding rows", "#d55e00", "s"),
            ("table", "radius"): ("radius, table", "#009e73", "^")}
PLACES = ("boundary", "corner", "crease", "dart")
SHARPNESSES = {0.5: "#56b4e9", 1.5: "#009e73", 2.5: "#e69f00", 4.5: "#d55e00", None: "#222222"}
PANELS = (3, 5, 6, 8, 12, 50)


def source(row):
    return row["bounds"], row["layout"]


def over_valences(axis, rows):
    """The valences of the rows, as ticks of equal distance."""
    valences = sorted({row["valence"] for row in rows})
    axis.set_xticks(range(len(valences)), valences)
    return valences


def plot_rates(rows, path):
    levels = max(len(row["thickness"]) for row in rows) - 1
    figure, axes = panels(2, 3, (9.8, 7.5), sharex=True, sharey=True)
    for axis, valence in zip(axes, PANELS):
        mine = [row for row in rows if row["valence"] == valence]
        radii = {source(row): row for row in mine if row["measure"] == "radius"}
        across = next(row for row in mine if row["measure"] == "normal" and source(row) == ("rows", None))
        axis.set_yscale("log", nonpositive="mask")
        for key, (words, colour, mark) in SOURCES.items():
            axis.plot(radii[key]["thickness"], mark, color=colour, ls="-", label=f"radius, {words}")
        _, colour, mark = SOURCES["rows", None]
        axis.plot(across["thickness"], mark, color=colour, ls="--", mfc="white", ms=4, label="slab along the normal, bounding rows")
        # Theory: through the last measured radius of each layout.
        for key, style in ((("table", "ngon"), "--"), (("table", "characteristic"), ":")):
            row = radii[key]
            last = len(row["thickness"]) - 1
            axis.plot([0.35 * row["thickness"][last] * row["expected"] ** (k - last) for k in range(last + 1)], style,
                      color=GREY, label=f"slope of theory, {key[1].replace('ngon', 'n-gon')}")
        axis.set(title=f"valence {valence}" + (" (regular)" if valence == 6 else ""), xticks=range(0, levels + 1, 2),
                 ylim=(1e-9, 1))
    for axis in axes[::3]:
        axis.set_ylabel("thickness (spokes of length 1)")
    for axis in axes[3:]:
        axis.set_xlabel("level")
    save(figure, path, "Radius at an extraordinary corner, level by level", 3)


def plot_factors(rows, path):
    figure, axes = panels(1, 2, (9.8, 4.4), sharey=True)
    for axis, (measure, title) in zip(axes, (("radius", "radius of the offset triangle"), ("normal", "slab along the limit normal"))):
        valences = over_valences(axis, rows)
        first = [next(row for row in rows if row["valence"] == v) for v in valences]
        for s, (key, (words, colour, mark)) in enumerate(SOURCES.items()):
            mine = [row for row in rows if row["measure"] == measure and source(row) == key]
            axis.plot([valences.index(row["valence"]) + 0.17 * (s - 1) for row in mine], [row["factor"] for row in mine], mark,
                      color=colour, label=words)
        for field, style, words in (("subdominant", "--", "subdominant"), ("next", ":", "next eigenvalue")):
            axis.plot([row[field] for row in first], style, color=GREY, label=words)
        axis.set(title=title, xlabel="valence", ylim=(0.1, 0.65))
    axes[0].set_ylabel("factor a level")
    save(figure, path, "Factor a level by which enclosures shrink, over the valence", 5)


def factor_panel(axis, rows, title, label):
    """Measured factors of MEASURES over the faces in the middle, with three eigenvalues."""
    valences = over_valences(axis, rows)
    first = [next(row for row in rows if row["valence"] == v) for v in valences]
    for s, (key, (words, colour, mark)) in enumerate(MEASURES.items()):
        mine = [row for row in rows if (row["bounds"], row["measure"]) == key]
        axis.plot([valences.index(row["valence"]) + 0.22 * (s - 1) for row in mine], [row["factor"] for row in mine], mark,
                  color=colour, ms=4, label=words)
    for field, style, words in (("subdominant", "--", "largest eigenvalue"), ("second", "-.", "second"), ("next", ":", "third")):
        axis.plot([row[field] for row in first], style, color=GREY, label=words)
    axis.set(title=title, xlabel=label, ylim=(0.1, 1))


def plot_schemes(documents, path):
    figure, axes = panels(1, 3, (9.8, 4.4), sharey=True)
    for axis, rows in zip(axes, documents):
        factor_panel(axis, rows, SCHEMES[rows[0]["scheme"]], "valence")
    axes[0].set_ylabel("factor a level")
    save(figure, path, "Factor a level by which enclosures shrink, over the valence, for three schemes", 6)


def plot_places(documents, path):
    figure, axes = panels(2, 3, (9.8, 7.5), sharey=True)
    for axis, (scheme, place) in zip(axes, [(s, p) for s in ("loop", "catmark") for p in ("boundary", "corner", "dart")]):
        factor_panel(axis, documents[scheme, place], f"{SCHEMES[scheme]}: {place}", "faces" if scheme == "catmark" else "")
    for axis in axes[::3]:
        axis.set_ylabel("factor a level")
    save(figure, path, "Factor a level by which enclosures shrink at boundaries and creases, over the faces there", 6)


def plot_semi_sharp(documents, path):
    """Radius by level beside creases of several sharpnesses in a regular mesh; None: infinite."""
    figure, axes = panels(1, 2, (9.8, 4.4), sharey=True)
    for axis, scheme in zip(axes, ("loop", "catmark")):
        found = {row["sharpness"]: row for row in documents[scheme, "semi-sharp"] + documents[scheme, "crease"]
                 if row["bounds"] == "rows" and row["measure"] == "radius" and row["valence"] == (6 if scheme == "loop" else 4)}
        for sharpness, colour in SHARPNESSES.items():
            axis.semilogy(found[sharpness]["thickness"][:13], "o-", color=colour, ms=3.5,
                          label=f"sharpness {sharpness}" if sharpness else "infinite")
        axis.set(title=SCHEMES[scheme], xlabel="level", xticks=range(0, 13, 2), ylim=(1e-9, 1))
    axes[0].set_ylabel("radius (spokes of length 1)")
    save(figure, path, "Radius beside a semi-sharp crease, level by level", 5)


def plot_tightness(rows, path):
    top = 10 ** math.ceil(math.log10(max(row["most"] for row in rows)))
    figure, axes = panels(1, 3, (9.8, 4.4), sharey=True)
    for axis, shape in zip(axes, ("bent", "bumpy", "flat")):
        valences = over_valences(axis, rows)
        axis.set_yscale("log")
        for s, (key, (words, colour, mark)) in enumerate(SOURCES.items()):
            mine = [row for row in rows if row["shape"] == shape and source(row) == key and row["patches"]]
            places = [valences.index(row["valence"]) + 0.26 * (s - 1) for row in mine]
            median, high, most = ([row[field] for row in mine] for field in ("median", "high", "most"))
            axis.vlines(places, median, most, color=colour, lw=0.7)
            axis.vlines(places, median, high, color=colour, lw=1.8)
            axis.plot(places, most, "_", color=colour, ms=4, mew=0.7)
            axis.plot(places, median, mark, color=colour, ms=4, label=words)
        axis.set(title={"bent": "bent nets", "bumpy": "bumpy nets", "flat": "nearly flat nets"}[shape], xlabel="valence",
                 ylim=(0.9, top))
        steps = [value * 10 ** e for e in range(3) for value in (1, 2, 5) if value * 10 ** e <= top]
        axis.set_yticks(steps, steps)
        axis.minorticks_off()
    axes[0].set_ylabel("radius / least radius")
    figure.text(0.99, 0.9, "mark: median, thick: to 95 %, thin: to the worst", ha="right", size=8)
    save(figure, path, "Radius over the least possible, by valence", 3)


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
