#pragma once

#include <optional>
#include <string>

#include <pybind11/pybind11.h>
#include <snug/run.h>

namespace snug::python {

namespace py = pybind11;

/// The keyword certificate: a path, or None. Made before the work, so that what cannot be written is told at once. One file for the answers of a call.
class CertificateFile {
 public:
  explicit CertificateFile(const py::object& path);

  /// The same run, whose answers are proved.
  [[nodiscard]] Run with(Run run) { return run.certificate = path_ ? &certificate_ : nullptr, run; }
  /// Writes the file, whole or not at all; a UserWarning says what it does not prove.
  template <class Answer>
  Answer written(Answer answer) {
    write();
    return answer;
  }

 private:
  void write() const;

  std::optional<std::string> path_;
  py::object file_;  // opened before the work
  Certificate certificate_;
};

}  // namespace snug::python
