#include <snug/base/names.h>

namespace snug {

std::string listed(const std::vector<std::string>& words, const char* conjunction) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 < words.size() ? ", " : " " + std::string(conjunction) + " ";
    text += words[i];
  }
  return text;
}

}  // namespace snug
