"""Plain SVG for drawings of meshes in docs/; plots are matplotlib's (plotting.py)."""

BLACK, GREY = "#222222", "#777777"


class Picture:
    """An SVG drawing; y grows downwards."""

    def __init__(self, width, height, title):
        self.parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" '
                      f'height="{height}" font-family="DejaVu Sans, Helvetica, Arial, sans-serif" font-size="12">',
                      f"<title>{title}</title>", f'<rect width="{width}" height="{height}" fill="#ffffff"/>']

    def line(self, x1, y1, x2, y2, colour=BLACK, width=1, dash=None):
        dashed = f' stroke-dasharray="{dash}"' if dash else ""
        self.parts.append(f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" '
                          f'stroke-width="{width}"{dashed}/>')

    def path(self, points, colour, width=1.5, dash=None):
        dashed = f' stroke-dasharray="{dash}"' if dash else ""
        where = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        self.parts.append(f'<polyline points="{where}" fill="none" stroke="{colour}" stroke-width="{width}"{dashed}/>')

    def polygon(self, points, fill="none", stroke="none", width=1, opacity=1, dash=None):
        dashed = f' stroke-dasharray="{dash}"' if dash else ""
        see_through = f' fill-opacity="{opacity}"' if opacity < 1 else ""
        where = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        self.parts.append(f'<polygon points="{where}" fill="{fill}" stroke="{stroke}" stroke-width="{width}" '
                          f'stroke-linejoin="round"{see_through}{dashed}/>')

    def mark(self, x, y, colour, size=3.2, hollow=False):
        self.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{size:.1f}" fill="{"#ffffff" if hollow else colour}" '
                          f'stroke="{colour}" stroke-width="1.2"/>')

    def text(self, x, y, words, anchor="start", colour=BLACK, size=12, bold=False):
        weight = ' font-weight="bold"' if bold else ""
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}" '
                          f'font-size="{size}"{weight}>{words}</text>')

    def save(self, path):
        path.write_text("\n".join(self.parts + ["</svg>", ""]), encoding="utf-8")


class Panel:
    """Part of a picture with coordinates of its own; y grows upwards."""

    def __init__(self, picture, left, top, scale, origin=(0, 0)):
        self.picture, self.left, self.top, self.scale, self.origin = picture, left, top, scale, origin

    def at(self, p):
        return self.left + self.scale * (p[0] - self.origin[0]), self.top - self.scale * (p[1] - self.origin[1])

    def all(self, points):
        return [self.at(p) for p in points]
