#include <picture/lettering.h>

#include <cstddef>
#include <map>

namespace snug {
namespace {

// On a grid of 4 by 6: two digits a place, x and y, and chains of places with blanks between.
const std::map<char, std::string_view>& glyphs() {
  static const std::map<char, std::string_view> all{
      {'A', "002640 1232"},
      {'B', "000636454433 0333 3342413000"},
      {'C', "4536160501103041"},
      {'D', "00062645412000"},
      {'E', "46060040 0333"},
      {'F', "460600 0333"},
      {'G', "45361605011030414323"},
      {'H', "0006 4046 0343"},
      {'I', "2026 1030 1636"},
      {'J', "4641301001"},
      {'K', "0006 4602 1440"},
      {'L', "060040"},
      {'M', "0006234640"},
      {'N', "00064046"},
      {'O', "1030414536160501 0110"},
      {'P', "000636454433 0333"},
      {'Q', "1030414536160501 0110 2240"},
      {'R', "000636454433 0333 2340"},
      {'S', "4536160504133342413010 1001"},
      {'T', "0646 2026"},
      {'U', "0601103041 4146"},
      {'V', "062046"},
      {'W', "0610233046"},
      {'X', "0046 0640"},
      {'Y', "062346 2320"},
      {'Z', "06460040"},
      {'0', "1030414536160501 0110"},
      {'1', "052620 1030"},
      {'2', "05163645440040"},
      {'3', "051636454433 1333 3342413010 1001"},
      {'4', "3036024242"},
      {'5', "460604344342413010 1001"},
      {'6', "4536160501103041423313 1302"},
      {'7', "064620"},
      {'8', "1333444536160504 0413 1302 0201 0110 1030 3041 4142 4233"},
      {'9', "0110304145361605041333 3344"},
      {'.', "2021"},
      {',', "2110"},
      {':', "2122 2425"},
      {'-', "1333"},
      {'+', "1333 2224"},
      {'=', "1232 1434"},
      {'%', "0046 0506 4041"},
      {'/', "0046"},
      {'(', "36242230"},
      {')', "16242210"},
      {'<', "350331"},
      {'>', "153311"},
      {'\'', "2625"},
      {'_', "0040"},
      {' ', ""},
  };
  return all;
}

constexpr double unit = 1.0 / 6, advance = 6 * unit;

std::string_view glyph(char c) {
  if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  const auto found = glyphs().find(c);
  return found != glyphs().end() ? found->second : "0006464000";
}

}  // namespace

std::vector<LetterStroke> lettering(std::string_view text) {
  std::vector<LetterStroke> strokes;
  double left = 0;
  for (const char c : text) {
    const std::string_view chains = glyph(c);
    bool begun = false;
    std::array<double, 2> last{};
    for (std::size_t i = 0; i < chains.size(); ++i) {
      if (chains[i] == ' ') {
        begun = false;
        continue;
      }
      if (i + 1 == chains.size() || chains[i + 1] == ' ') continue;
      const std::array<double, 2> place{left + unit * (chains[i] - '0'), unit * (chains[i + 1] - '0')};
      ++i;
      if (begun) strokes.push_back({last, place});
      begun = true;
      last = place;
    }
    left += advance;
  }
  return strokes;
}

double lettering_width(std::string_view text) {
  return text.empty() ? 0 : advance * static_cast<double>(text.size()) - 2 * unit;
}

}  // namespace snug
