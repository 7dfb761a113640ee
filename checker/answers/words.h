#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace answers {

/// The words of a text, one after another. What is not as expected is thrown as checker::Rejected,
/// with the number of the line.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  /// The next word; of a text that ends here, empty.
  [[nodiscard]] std::string_view peek() const;
  std::string_view next();
  void expect(std::string_view word);
  /// Is this the next word? Then it is taken.
  bool take(std::string_view word);
  /// A decimal or hexadecimal number, as the double nearest to it.
  double real();
  /// An integer from `least` to `most`.
  std::int64_t integer(std::int64_t least, std::int64_t most);
  std::uint32_t count(std::uint32_t most) { return static_cast<std::uint32_t>(integer(0, most)); }

  [[nodiscard]] std::size_t position() const { return at_; }
  /// From there to where the next word begins.
  [[nodiscard]] std::string_view up_to_next(std::size_t begin) const;
  [[nodiscard]] std::size_t line() const { return line_; }
  [[noreturn]] void refuse(const std::string& why) const;

 private:
  std::string_view text_;
  std::size_t at_ = 0;    // behind the last word
  std::size_t line_ = 1;  // of the last word
};

/// The SHA-256 digest of some bytes, in hexadecimal digits. Source: FIPS 180-4.
[[nodiscard]] std::string sha256(std::string_view bytes);

}  // namespace answers
