"""Matplotlib for the plots of docs/: the same bytes for the same data, and text that stays text."""

import matplotlib
from matplotlib import pyplot
from matplotlib.layout_engine import ConstrainedLayoutEngine

BLACK, GREY = "#222222", "#777777"

matplotlib.use("svg")
pyplot.rcParams.update({
    "svg.hashsalt": "snug", "svg.fonttype": "none", "font.family": "DejaVu Sans", "font.size": 9, "axes.titlesize": 9,
    "axes.titleweight": "bold", "axes.edgecolor": BLACK, "axes.axisbelow": True, "axes.grid": True, "axes.grid.axis": "y",
    "grid.color": "#dddddd", "lines.linewidth": 1.2, "lines.markersize": 4.5, "legend.frameon": False})


def panels(rows, columns, size, **options):
    """A figure of `size` inches, with room for a legend above its panels, and these one by one."""
    layout = ConstrainedLayoutEngine(rect=(0, 0, 1, 1 - 0.5 / size[1]))
    figure, axes = pyplot.subplots(rows, columns, figsize=size, squeeze=False, layout=layout, **options)
    return figure, axes.flat


def save(figure, path, title, columns):
    """With a legend of the first panel's labels in so many columns."""
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="upper center", ncol=columns)
    figure.savefig(path, metadata={"Title": title, "Creator": None, "Date": None})
    pyplot.close(figure)
