#include "contact_report.h"

#include <algorithm>

#include <fmt/core.h>
#include <support/atomic_file.h>

namespace snug::command {
namespace {

// Of those printed for people.
constexpr std::size_t max_area_lines = 20, max_area_corners = 8;

std::string number_of(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string region_line(const Sides& sides, const ContactRegion& region, std::size_t number) {
  const auto owners = [&](std::size_t s) {
    const bool primal = !sides[s].surface().traits().dual;
    return number_of(region.owners[s].size(), primal ? "face" : "vertex", primal ? "faces" : "vertices");
  };
  const Vector3 sides_of_box = region.box.upper - region.box.lower;
  std::string text = fmt::format("region {}: {}, {} of A and {} of B, size {:.4g} x {:.4g} x {:.4g}", number,
                                 name_of(region.verdict), owners(0), owners(1), sides_of_box.x,
                                 sides_of_box.y, sides_of_box.z);
  if (region.verdict != Verdict::intersecting) {
    text += fmt::format(", distance in [{}, {}]", text_at_most(region.distance.lower),
                        text_at_most(region.distance.upper, true));
  }
  return text;
}

std::string curve_line(const IntersectionCurve& curve, std::size_t number) {
  const auto unproved =
      std::count_if(curve.boxes.begin(), curve.boxes.end(), [](const CurveBox& b) { return !b.one_arc; });
  std::string text = fmt::format("curve {}: {}, {} points within {} of both surfaces, region {}, ", number,
                                 curve.closed ? "closed" : "open", curve.points.size(),
                                 text_at_most(curve.error, true), curve.region);
  return text + (curve.proved ? "proved"
                              : fmt::format("{} of {} boxes not proved to contain one arc", unproved,
                                            curve.boxes.size()));
}

std::string area_line(const ContactArea& area, std::size_t number) {
  const std::size_t count = area.points.size();
  std::string text = fmt::format("area {}: {}, face {} of A and face {} of B, region {}:", number,
                                 count == 1   ? "a point"
                                 : count == 2 ? "a segment"
                                              : fmt::format("a polygon of {} corners", count),
                                 area.faces[0], area.faces[1], area.region);
  for (std::size_t i = 0; i < count && i < max_area_corners; ++i) {
    const Point3& p = area.points[i];
    text += fmt::format("{} ({:.6g} {:.6g} {:.6g})", i == 0 ? "" : ",", p.x, p.y, p.z);
  }
  return text + (count > max_area_corners ? ", ..." : "");
}

}  // namespace

std::vector<std::string> contact_lines(const Sides& sides, const Contacts& found) {
  std::vector<std::string> lines;
  lines.push_back(fmt::format("{}, {}, {}, {}", number_of(found.regions.size(), "region", "regions"),
                              number_of(found.curves.size(), "intersection curve", "intersection curves"),
                              number_of(found.areas.size(), "area", "areas"),
                              number_of(found.open.size(), "open box", "open boxes")));
  for (std::size_t i = 0; i < found.regions.size(); ++i) {
    lines.push_back(region_line(sides, found.regions[i], i));
  }
  for (std::size_t i = 0; i < found.curves.size(); ++i) lines.push_back(curve_line(found.curves[i], i));
  for (std::size_t i = 0; i < found.areas.size() && i < max_area_lines; ++i)
    lines.push_back(area_line(found.areas[i], i));
  if (found.areas.size() > max_area_lines)
    lines.push_back(fmt::format("{} more areas: see --json", found.areas.size() - max_area_lines));
  if (!found.exhaustive) {
    lines.emplace_back("not complete: the budget ended; give a larger --max-splits or a smaller --tolerance");
  } else if (found.outcome != Outcome::complete) {
    lines.emplace_back(found.outcome == Outcome::budget_spent
                           ? "coarser than asked: the budget ended; give a larger --max-splits"
                           : "coarser than asked: surfaces lie in each other, or touch where a curve passes");
  }
  return lines;
}

void write_curves(const std::vector<IntersectionCurve>& curves, AtomicFile& file) {
  std::size_t first = 1;
  for (const IntersectionCurve& curve : curves) {
    for (const Point3& p : curve.points) file.write(fmt::format("v {} {} {}\n", p.x, p.y, p.z));
    std::string line = "l";
    for (std::size_t i = 0; i < curve.points.size(); ++i) line += fmt::format(" {}", first + i);
    if (curve.closed) line += fmt::format(" {}", first);
    file.write(line + "\n");
    first += curve.points.size();
  }
}

}  // namespace snug::command
