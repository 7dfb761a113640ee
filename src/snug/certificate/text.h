#pragma once

#include <array>
#include <string>

#include <snug/geometry.h>
#include <support/number.h>

namespace snug {

/// Appends numbers, each behind a space.
template <class... Numbers>
void append_words(std::string& text, const Numbers&... numbers) {
  const auto append = [&](const auto& number) {
    text += ' ';
    if constexpr (std::is_floating_point_v<std::decay_t<decltype(number)>>) {
      append_real(text, number);
    } else {
      append_integer(text, number);
    }
  };
  (append(numbers), ...);
}

/// Appends a number exactly, as a hexadecimal integer times a power of two.
void append_exactly(std::string& text, double value);

}  // namespace snug
