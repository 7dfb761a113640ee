#include "scene_answer.h"

#include <array>
#include <charconv>

#include <fmt/core.h>

#include "scene_file.h"

namespace snug::command {
namespace {

template <class Integer>
bool read_number(std::string_view text, Integer& number, int base = 10) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

std::string line_of(const PartPair& parts, const SceneAnswer& answer) {
  std::string line =
      fmt::format("{}\t{}\t{}\t{}\t{}\t{}\t", parts.a, parts.b, static_cast<int>(answer.verdict),
                  answer.reached ? 1 : 0, answer.row, answer.json);
  line += fmt::format("{:016x}\n", fingerprint(line));
  return line;
}

bool parse_line(std::string_view line, PartPair& parts, SceneAnswer& answer) {
  std::array<std::string_view, 7> words;
  std::string_view rest = line;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto end = rest.find('\t');
    if ((end == std::string_view::npos) != (i + 1 == words.size())) return false;
    words[i] = rest.substr(0, end);
    if (end != std::string_view::npos) rest.remove_prefix(end + 1);
  }
  int verdict = 0, reached = 0;
  std::uint64_t sum = 0;
  const bool numbers = read_number(words[0], parts.a) && read_number(words[1], parts.b) &&
                       read_number(words[2], verdict) && read_number(words[3], reached) &&
                       words[6].size() == 16 && read_number(words[6], sum, 16);
  if (!numbers || sum != fingerprint(line.substr(0, line.size() - 16)) || verdict < 0 || verdict > 3)
    return false;
  answer = {static_cast<Verdict>(verdict), reached != 0, std::string(words[4]), std::string(words[5])};
  return true;
}

}  // namespace snug::command
