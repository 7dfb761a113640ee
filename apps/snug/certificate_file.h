#pragma once

#include <optional>
#include <vector>

#include <support/atomic_file.h>

#include "common.h"

namespace snug::command {

/// Adds --certificate.
Option& add_certificate_option(OptionList& list, CommonOptions& options);

/// The file of --certificate, if one is wanted.
class CertificateFile {
 public:
  /// Errors:    InputError (unreadable) if it cannot be written.
  explicit CertificateFile(const CommonOptions& options);

  /// The same run, whose answers are proved.
  [[nodiscard]] Run with(Run run) { return run.certificate = file_ ? &certificate_ : nullptr, run; }
  [[nodiscard]] bool wanted() const { return file_.has_value(); }
  /// Writes the proof and adds the file to those that a report puts in place, and its name and what it does not prove to the
  /// report's document.
  /// Notes:     one line for what it does not prove.
  void add_to(Report& report, std::vector<AtomicFile*>& files);

 private:
  Notes notes_;
  std::string name_;
  std::optional<AtomicFile> file_;
  Certificate certificate_;
};

}  // namespace snug::command
