#include "file.h"

#include "../rejected.h"

namespace answers {
namespace {

class File {
 public:
  File(std::string_view text, LeastSlack& least, std::size_t most_points)
      : words_(text), points_left_(most_points), least_(least) {}

  std::vector<std::string> check() {
    try {
      return proved();
    } catch (const checker::Rejected& rejected) {
      const std::string_view why = rejected.what();
      if (why.starts_with("line ")) throw;
      words_.refuse(std::string(why));
    }
  }

 private:
  std::vector<std::string> proved() {
    words_.expect("snug-certificate");
    words_.integer(1, 1);
    while (!words_.take("end")) {
      if (words_.take("surface")) {
        read_surface();
      } else {
        words_.expect("question");
        check_question();
      }
    }
    if (!words_.peek().empty()) words_.refuse("something follows the end");
    if (proved_.empty()) words_.refuse("no question");
    return std::move(proved_);
  }

  void read_surface() {
    for (const auto& all : all_) all->forget();
    surfaces_.push_back(answers::read_surface(words_, points_left_));
    const Surface& surface = *surfaces_.back();
    points_left_ -= surface.net.points.size();
    most_points_ = points_left_;
    const std::shared_ptr<const Net> net(&surface.net, [](const Net*) {});
    all_.push_back(std::make_unique<PieceSet>(
        surface, net, 0, static_cast<Index>(net->owners.size()), points_left_));
  }

  Side read_side() {
    Side side;
    if (words_.take("point")) {
      side.points.push_back(read_point(side.name));
      side.name = "the point (" + side.name + ")";
    } else if (words_.take("ray")) {
      read_ray(side);
    } else {
      words_.expect("placed");
      if (all_.empty()) words_.refuse("no surface yet");
      const Index which = words_.count(static_cast<Index>(all_.size()) - 1);
      side.pieces = all_[which].get();
      side.name =
          "surface " + std::to_string(which) + " (" + surfaces_[which]->name + ") placed by";
      std::array<double, 12> numbers{};
      for (double& x : numbers) {
        side.name += ' ' + std::string(words_.peek());
        x = words_.real();
      }
      side.pose = Pose(numbers);
    }
    return side;
  }

  Point read_point(std::string& text) {
    Point p;
    for (Real& x : p) {
      text += (text.empty() ? "" : ", ") + std::string(words_.peek());
      x = Real(words_.real());
    }
    return p;
  }

  // The points origin + t direction, from the first to the second number.
  void read_ray(Side& side) {
    std::string origin, along;
    const Point from = read_point(origin), direction = read_point(along);
    side.name = "the ray from (" + origin + ") along (" + along + ")";
    const auto at = [&](double t) {
      Point p = from;
      for (std::size_t i = 0; i < 3; ++i) p[i].add_product(Real(t), direction[i]);
      return p;
    };
    side.name += ", from " + std::string(words_.peek());
    const double begin = words_.real();
    side.points.push_back(at(begin));
    side.name += " to " + std::string(words_.peek());
    if (words_.take("inf")) {
      side.direction = direction;
      return;
    }
    const double end = words_.real();
    if (end < begin) words_.refuse("a ray that ends before it begins");
    side.points.push_back(at(end));
  }

  void check_question() {
    const bool is_scene = words_.take("scene");
    is_scene ? check_scene() : check_pair();
    if (points_left_ < most_points_ / 2) {  // what earlier questions needed may be of no use
      for (const auto& all : all_) all->forget();
    }
  }

  void check_pair() {
    Question question;
    for (Side& side : question.sides) side = read_side();
    proved_.push_back(question.sides[0].name + " and " + question.sides[1].name + ' ' +
                      prove_claims(words_, question, least_));
  }

  void check_scene() {
    const std::size_t begin = words_.position() - std::string_view("scene").size();
    std::vector<Side> parts;
    for (Index left = words_.count(most_parts); left > 0; --left) {
      if (words_.peek() != "placed") words_.refuse("a part that is no placed surface");
      if (points_left_ < points_of_a_part) words_.refuse("more parts than this program keeps");
      points_left_ -= points_of_a_part;
      parts.push_back(read_side());
      parts.back().name.clear();
    }
    most_points_ = points_left_;
    if (parts.empty()) words_.refuse("no parts");
    const std::string number = "scene " + std::to_string(scenes_++);
    std::string name = number + " of " + std::to_string(parts.size()) + " parts, sha256 " +
                       sha256(words_.up_to_next(begin));
    for (std::size_t i = 0; i < surfaces_.size(); ++i)
      name += ", of surface " + std::to_string(i) + " (" + surfaces_[i]->name + ")";
    const std::vector<std::string> sentences = prove_scene(words_, parts, least_);
    if (sentences.empty()) words_.refuse("a scene without a claim");
    for (const std::string& sentence : sentences) {
      proved_.push_back(name + ": " + sentence);
      name = number;
    }
  }

  static constexpr Index most_parts = 1U << 20;
  static constexpr std::size_t points_of_a_part = 5;
  Words words_;
  std::size_t scenes_ = 0;
  std::size_t points_left_, most_points_ = 0;  // most: when no set has made any
  std::vector<std::unique_ptr<Surface>> surfaces_;
  std::vector<std::unique_ptr<PieceSet>> all_;
  std::vector<std::string> proved_;
  LeastSlack& least_;
};

}  // namespace

std::vector<std::string> check(std::string_view text, LeastSlack& least, std::size_t most_points) {
  return File(text, least, most_points).check();
}

}  // namespace answers
