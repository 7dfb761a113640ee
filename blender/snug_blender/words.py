# SPDX-License-Identifier: GPL-3.0-or-later
"""Answers as sentences. Ends of intervals are rounded outwards."""

import decimal

_DOWN = decimal.Context(prec=6, rounding=decimal.ROUND_FLOOR)
_UP = decimal.Context(prec=6, rounding=decimal.ROUND_CEILING)


def at_least(x):
    return f"{_DOWN.create_decimal_from_float(float(x)).normalize():f}"


def at_most(x):
    return f"{_UP.create_decimal_from_float(float(x)).normalize():f}"


def interval(lower, upper):
    return f"between {at_least(lower)} and {at_most(upper)}"


def intersect(a, b):
    return f"{a} and {b} intersect: proved"


def pair(a, b, hit):
    if hit.verdict == "intersecting":
        return intersect(a, b)
    if hit.verdict == "separated":
        return f"{a} and {b} do not touch: proved"
    return f"{a} and {b}: undecided, but at most {at_most(hit.upper)} apart"


def apart(a, b, gap):
    return intersect(a, b) if gap.upper == 0 else f"{a} and {b}: {interval(gap.lower, gap.upper)} apart"
