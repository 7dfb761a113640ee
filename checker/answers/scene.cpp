#include <algorithm>
#include <set>

#include "tree.h"

// Many parts: docs/certificates.md, "Scenes".
namespace answers {
namespace {

class Scene {
 public:
  Scene(Words& words, const std::vector<Side>& parts, LeastSlack& least)
      : words_(words), parts_(parts), least_(least) {}

  std::vector<std::string> prove() {
    read_order();
    while (true) {
      if (!open_ && words_.take("hulls")) {
        prove_hulls_apart();
      } else if (words_.take("pair")) {
        const auto [i, j] = read_pair();
        if (open_) open_->erase(std::minmax(i, j));
        Question question;
        question.sides = {parts_[i], parts_[j]};
        proved_.push_back("parts " + std::to_string(i) + " and " + std::to_string(j) + ' ' +
                          prove_claims(words_, question, least_));
      } else {
        if (open_) say_what_is_open();
        return std::move(proved_);
      }
    }
  }

 private:
  void read_order() {
    words_.expect("order");
    std::vector<bool> named(parts_.size());
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const Index part = read_part();
      if (named[part]) words_.refuse("this part is there already");
      named[part] = true;
      order_.push_back(part);
    }
  }

  Index read_part() { return words_.count(static_cast<Index>(parts_.size()) - 1); }
  std::pair<Index, Index> read_pair() {
    const Index i = read_part(), j = read_part();
    if (i == j) words_.refuse("a part and itself");
    return {i, j};
  }

  // Of all pairs but those that are named: of the first half of the parts with the second, then of
  // each half among itself.
  void prove_hulls_apart() {
    const double margin = words_.real();
    if (margin < 0) words_.refuse("a negative margin");
    std::set<std::pair<Index, Index>>& except = open_.emplace();
    std::string names;
    for (Index left = words_.count(most_pairs); left > 0; --left) {
      const auto [i, j] = read_pair();
      except.insert(std::minmax(i, j));
      names += (names.empty() ? " but " : ", ") + std::to_string(i) + " and " + std::to_string(j);
    }
    std::vector<const Side*> sides;
    for (const Index part : order_) sides.push_back(&parts_[part]);
    const Tree tree(words_, std::move(sides), margin, least_);
    const auto leave_out = [&](const Range& a, const Range& b) {
      if (a.size() != 1 || b.size() != 1) words_.refuse("more than two parts");
      if (!except.contains(std::minmax(order_[a.begin], order_[b.begin])))
        words_.refuse("a pair that is not named is left out");
    };
    std::vector<Range> among{{0, parts_.size()}};
    while (!among.empty()) {
      const Range all = among.back();
      among.pop_back();
      if (all.size() < 2) continue;
      const auto [first, second] = tree.halves_of(all);
      tree.prove(first, second, leave_out);
      among.push_back(second);
      among.push_back(first);
    }
    proved_.push_back("all pairs of parts" + names + " lie in convex hulls that " +
                      (margin == 0 ? "have no point in common"
                                   : "are farther apart than " + text_of(margin, false)));
  }

  void say_what_is_open() {
    std::string names;
    for (const auto& [i, j] : *open_)
      names += (names.empty() ? "" : ", ") + std::to_string(i) + " and " + std::to_string(j);
    proved_.push_back(names.empty() ? "every pair of parts has a claim"
                                    : "no claim is made about parts " + names);
  }

  static constexpr Index most_pairs = 1U << 26;
  Words& words_;
  const std::vector<Side>& parts_;
  LeastSlack& least_;
  std::vector<Index> order_;
  std::vector<std::string> proved_;
  std::optional<std::set<std::pair<Index, Index>>>
      open_;  // pairs without a claim, once there are hulls
};

}  // namespace

std::vector<std::string> prove_scene(Words& words, const std::vector<Side>& parts,
                                     LeastSlack& least) {
  return Scene(words, parts, least).prove();
}

}  // namespace answers
