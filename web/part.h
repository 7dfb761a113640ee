#pragma once

#include <memory>
#include <string>
#include <vector>

#include "values.h"

namespace snug::web {

inline constexpr std::size_t scheme_count = static_cast<std::size_t>(Scheme::flat) + 1;

// A surface, and what is told of how it was made.
class Part {
 public:
  // Errors: InputError, with the name before it.
  Part(ControlMesh mesh, const std::string& name, const val& options, std::vector<std::string> notes = {});

  [[nodiscard]] const Surface& surface() const { return surface_; }
  [[nodiscard]] double size() const { return surface_.size(); }
  [[nodiscard]] std::string scheme() const { return name_of(surface_.scheme()); }
  [[nodiscard]] std::string boundary() const;
  [[nodiscard]] val notes() const;

 private:
  Surface made(ControlMesh mesh, const std::string& name, const val& options);

  std::vector<std::string> notes_;
  Surface surface_;
};

// How a file is read: what others it names come from options.files(path), lines about it go to `notes`.
ReadOptions reading_of(const val& options, std::vector<std::string>& notes);

// What is no index, such as a negative number or a fraction, is refused; so is a list that is no multiple of `each`.
std::uint32_t index_of(double number, const char* what);
std::vector<double> numbers_of(const val& object, const char* name, std::size_t each);

}  // namespace snug::web
