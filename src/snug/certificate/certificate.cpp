#include <snug/certificate/certificate.h>

#include <cmath>

#include <snug/certificate/meeting.h>
#include <snug/certificate/text.h>
#include <snug/certificate/winding.h>
#include <support/point.h>

namespace snug {
namespace {

constexpr std::size_t max_leaves = 100'000;
constexpr std::size_t max_place_steps = 400;  // of the name of a piece
constexpr double place_size = 0x1p-40;        // of a piece, in sizes of its surface

// No two points of the boxes are farther apart.
double farthest(const Box3& a, const Box3& b) {
  Vector3 between;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    between[axis] =
        std::max(std::fabs(b.upper[axis] - a.lower[axis]), std::fabs(a.upper[axis] - b.lower[axis]));
  }
  return length(between);
}

}  // namespace

void append_exactly(std::string& text, double value) {
  if (value < 0) text += '-';
  int exponent = 0;
  auto mantissa = static_cast<std::uint64_t>(std::ldexp(std::frexp(std::fabs(value), &exponent), 53));
  exponent -= 53;
  for (; mantissa != 0 && mantissa % 2 == 0; mantissa /= 2) ++exponent;
  std::string digits;
  for (; mantissa != 0; mantissa /= 16) digits.insert(digits.begin(), "0123456789abcdef"[mantissa % 16]);
  text += value == 0 ? "0x0p0" : "0x" + digits + "p" + std::to_string(exponent);
}

std::size_t CertificateWriter::index_of(const Surface& surface) {
  const auto [known, is_new] = indices_.try_emplace(surface.data().get(), surfaces_.size());
  if (is_new) {
    surfaces_.push_back(std::make_unique<CertifiedSurface>(surface));
    surfaces_.back()->write(text_);
  }
  return known->second;
}

CertifiedSide CertificateWriter::append_placed(const PlacedSurface& surface) {
  const std::size_t index = index_of(surface.surface());
  text_ += "placed";
  append_words(text_, index);
  for (const double x : surface.pose().numbers()) append_words(text_, x);
  text_ += '\n';
  return side_of(surfaces_[index]->all(), surface.pose());
}

void CertificateWriter::set_side(std::size_t side, const PlacedSurface& surface) {
  of_sides_[side] = surfaces_[index_of(surface.surface())].get();
  sides_[side] = append_placed(surface);
}

void CertificateWriter::begin_question() {
  question_ = text_.size();
  text_ += "question\n";
}

void CertificateWriter::drop_question_without_claim() {
  if (question_ != 0) {
    if (text_.size() == claims_) {
      text_.resize(question_);
    } else {
      has_claims_ = true;
    }
  }
  question_ = 0;
  are_apart_ = false;
  // What earlier questions needed of the surfaces may be of no use.
  if (++asked_ % 256 == 0) {
    for (const auto& surface : surfaces_) surface->all().forget();
  }
}

void CertificateWriter::drop_scene_without_claim() {
  drop_question_without_claim();
  if (!scene_) return;
  if (text_.size() == scene_claims_) text_.resize(scene_begin_);
  scene_.reset();
}

void CertificateWriter::ask(std::span<const PlacedSurface> parts) {
  drop_scene_without_claim();
  for (const PlacedSurface& part : parts) index_of(part.surface());
  scene_begin_ = text_.size();
  text_ += "question\nscene ";
  append_integer(text_, parts.size());
  text_ += '\n';
  std::vector<CertifiedSide> sides;
  of_parts_.clear();
  for (const PlacedSurface& part : parts) {
    sides.push_back(append_placed(part));
    of_parts_.push_back(surfaces_[index_of(part.surface())].get());
  }
  scene_.emplace(std::move(sides));
  text_ += "order";
  for (const std::uint32_t part : scene_->order()) append_words(text_, part);
  text_ += '\n';
  scene_claims_ = text_.size();
}

void CertificateWriter::hulls(double margin, std::set<PartNumbers>& except) {
  std::string proof;
  scene_->append(proof, margin, except, monitor_);
  const std::size_t parts = of_parts_.size();
  if (except.size() == parts * (parts - 1) / 2) return;  // of no pair
  text_ += "hulls ";
  append_exactly(text_, margin);
  append_words(text_, except.size());
  for (const auto& [i, j] : except) append_words(text_, i, j);
  text_ += '\n' + proof;
  has_claims_ = true;
}

void CertificateWriter::pair(std::uint32_t a, std::uint32_t b) {
  drop_question_without_claim();
  question_ = text_.size();
  text_ += "pair";
  append_words(text_, a, b);
  text_ += '\n';
  sides_ = {scene_->part(a), scene_->part(b)};
  of_sides_ = {of_parts_[a], of_parts_[b]};
  claims_ = text_.size();
}

void CertificateWriter::ask(const PlacedSurface& a, const PlacedSurface& b) {
  drop_scene_without_claim();
  for (const PlacedSurface* side : {&a, &b}) index_of(side->surface());
  begin_question();
  set_side(0, a);
  set_side(1, b);
  claims_ = text_.size();
}

void CertificateWriter::ask(const PlacedSurface& a, const Point3& b) {
  drop_scene_without_claim();
  index_of(a.surface());
  begin_question();
  set_side(0, a);
  sides_[1] = side_of({b});
  text_ += "point";
  append_words(text_, b.x, b.y, b.z);
  text_ += '\n';
  claims_ = text_.size();
}

void CertificateWriter::ask(const PlacedSurface& a, const Ray& b) {
  drop_scene_without_claim();
  index_of(a.surface());
  begin_question();
  set_side(0, a);
  const auto at = [&](double t) { return b.origin + t * b.direction; };
  const bool ends = b.to < INFINITY;
  sides_[1] = ends ? side_of({at(b.from), at(b.to)}) : side_of({at(b.from)}, b.direction);
  sides_[1].magnitude = std::max(sides_[1].magnitude, max_abs(b.origin - Point3{}));
  text_ += "ray";
  append_words(text_, b.origin.x, b.origin.y, b.origin.z, b.direction.x, b.direction.y, b.direction.z,
               b.from);
  if (ends) {
    append_words(text_, b.to);
  } else {
    text_ += " inf";
  }
  text_ += '\n';
  claims_ = text_.size();
}

Found CertificateWriter::apart(double margin) {
  const std::size_t before = text_.size();
  text_ += "apart ";
  append_exactly(text_, margin);
  text_ += '\n';
  const Found found = append_separation(text_, sides_, margin, {max_leaves, monitor_});
  if (found != Found::proof) text_.resize(before);
  if (found == Found::proof) are_apart_ = true;
  return found;
}

Found CertificateWriter::at_least(double lower) {
  const double largest = std::max({lower, sides_[0].magnitude, sides_[1].magnitude});
  const Found found = apart(std::max(0.0, lower - 0x1p-38 * largest));
  if (found == Found::proof) return found;
  for (const double share : {0.9, 0.5, 0.0}) {
    if (apart(share * lower) == Found::proof) break;
  }
  return found;
}

Box3 CertificateWriter::append_place(std::size_t side, const Place& at) {
  const CertifiedSurface& surface = *of_sides_[side];
  const double wanted = std::max(place_size * surface.surface().size(), 0x1p-48 * sides_[side].magnitude);
  const std::vector<std::size_t> steps = surface.steps_to(at, max_place_steps);
  std::unique_ptr<NetRange> piece = sides_[side].pieces->only(surface.position_of(at.owner));
  Box3 box = box_of(piece->hull(sides_[side].pose));
  std::string taken;
  std::size_t count = 0;
  for (; count < steps.size() && longest_side(box) > wanted; ++count) {
    piece = piece->finer().only(steps[count]);
    box = box_of(piece->hull(sides_[side].pose));
    append_words(taken, steps[count]);
  }
  text_ += "on";
  append_words(text_, surface.position_of(at.owner), count);
  text_ += taken + '\n';
  return box;
}

double CertificateWriter::near(double upper, const Place& a, const Place* b) {
  const std::size_t before = text_.size();
  const Box3 box_a = append_place(0, a);
  Box3 box_b;
  if (b != nullptr) {
    box_b = append_place(1, *b);
  } else {
    text_ += "here\n";
    box_b.add(sides_[1].points[0]);
  }
  const double noise = 0x1p-46 * (sides_[0].magnitude + sides_[1].magnitude);
  const double proved = std::max(upper, farthest(box_a, box_b) * (1 + 0x1p-48) + noise);
  std::string claim = "near ";
  append_exactly(claim, proved);
  text_.insert(before, claim + '\n');
  return proved;
}

bool CertificateWriter::meet(const Place& a, const Place* b) {
  const auto name = [&](std::size_t side, const Place& at) {
    const CertifiedSurface& surface = *of_sides_[side];
    return CertifiedPiece{surface.position_of(at.owner), surface.steps_to(at, max_place_steps)};
  };
  return append_meeting(text_, sides_, {name(0, a), b ? std::optional(name(1, *b)) : std::nullopt}, monitor_);
}

std::optional<int> CertificateWriter::winding(std::size_t side, const Place* at) {
  const std::size_t before = text_.size();
  text_ += "winding";
  append_words(text_, side);
  text_ += ' ';
  Box3 point;
  if (at != nullptr) {
    point = append_place(side, *at);
  } else {
    text_ += "here\n";
    point.add(sides_[side].points[0]);
  }
  const auto proof = winding_proof(sides_[1 - side], point, sides_[side].magnitude, monitor_);
  if (!proof) {
    text_.resize(before);
    return std::nullopt;
  }
  text_ += std::to_string(proof->number);
  text_ += proof->text;
  return proof->number;
}

bool CertificateWriter::solids_apart() {
  if (!are_apart_) return false;
  const std::size_t before = text_.size();
  for (std::size_t side = 0; side < 2; ++side) {
    for (const std::uint32_t owner : of_sides_[side]->owner_of_each_component()) {
      const Place at{.owner = owner, .u = 0.25, .v = 0.25};
      if (winding(side, &at) == 0) continue;
      text_.resize(before);
      return false;
    }
  }
  text_ += "solids\n";
  return true;
}

bool CertificateWriter::solids_meet(std::size_t side, const Place& at) {
  const std::size_t before = text_.size();
  if (winding(side, &at).value_or(0) == 0) {
    text_.resize(before);
    return false;
  }
  text_ += "solids\n";
  return true;
}

std::string CertificateWriter::finished() {
  drop_scene_without_claim();
  return has_claims_ ? std::move(text_) + "end\n" : std::string();
}

}  // namespace snug
