#include "contact_report.h"

#include <algorithm>

#include <fmt/core.h>
#include <support/atomic_file.h>

namespace snug::command {
namespace {

// Of those printed for people.
constexpr std::size_t max_area_lines = 20, max_area_corners = 8;

void write_interval(JsonWriter& json, const char* name, const Interval& interval) {
  json.key(name).begin_array().value(interval.lower).value(interval.upper).end_array();
}

void write_box(JsonWriter& json, const Box3& box) {
  json.key("box").begin_array().value(box.lower).value(box.upper).end_array();
}

void write_patches(JsonWriter& json, const std::array<PatchPlace, 2>& patches) {
  json.field("a", patches[0].owner).field("part_a", patches[0].part);
  json.field("b", patches[1].owner).field("part_b", patches[1].part);
}

void write_region(JsonWriter& json, const Sides& sides, const ContactRegion& region) {
  json.begin_object().field("verdict", name_of(region.verdict));
  write_interval(json, "distance", region.distance);
  write_box(json, region.box);
  write_witness(json, sides, &region.witness);
  for (std::size_t s = 0; s < 2; ++s) {
    json.key(s == 0 ? "owners_a" : "owners_b").begin_array();
    for (const std::uint32_t owner : region.owners[s]) json.value(owner);
    json.end_array();
  }
  json.key("contacts").begin_array();
  for (const PatchContact& contact : region.contacts) {
    json.begin_object();
    write_patches(json, contact.patches);
    json.field("verdict", name_of(contact.verdict));
    write_interval(json, "distance", contact.distance);
    json.end_object();
  }
  json.end_array().end_object();
}

void write_curve(JsonWriter& json, const IntersectionCurve& curve) {
  json.begin_object()
      .field("region", curve.region)
      .field("closed", curve.closed)
      .field("proved", curve.proved);
  json.field("error", curve.error);
  json.key("at_border").begin_array().value(curve.at_border[0]).value(curve.at_border[1]).end_array();
  json.key("points").begin_array();
  for (const Point3& p : curve.points) json.value(p);
  json.end_array().key("boxes").begin_array();
  for (const CurveBox& box : curve.boxes) {
    json.begin_object();
    write_box(json, box.box);
    json.field("one_arc", box.one_arc).end_object();
  }
  json.end_array().end_object();
}

void write_area(JsonWriter& json, const ContactArea& area) {
  json.begin_object().field("region", area.region).field("a", area.faces[0]).field("b", area.faces[1]);
  json.field("error", area.error).key("points").begin_array();
  for (const Point3& p : area.points) json.value(p);
  json.end_array().end_object();
}

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

void write_contacts(JsonWriter& json, const Sides& sides, const Contacts& found) {
  json.field("exhaustive", found.exhaustive);
  json.key("regions").begin_array();
  for (const ContactRegion& region : found.regions) write_region(json, sides, region);
  json.end_array().key("curves").begin_array();
  for (const IntersectionCurve& curve : found.curves) write_curve(json, curve);
  json.end_array().key("areas").begin_array();
  for (const ContactArea& area : found.areas) write_area(json, area);
  json.end_array().key("open").begin_array();
  for (const OpenBox& open : found.open) {
    json.begin_object();
    write_box(json, open.box);
    write_patches(json, open.patches);
    json.field("region", open.region).end_object();
  }
  json.end_array();
}

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
