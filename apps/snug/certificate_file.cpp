#include "certificate_file.h"

#include <support/system_files.h>

namespace snug::command {

Option& add_certificate_option(OptionList& list, CommonOptions& options) {
  return list.add(Group::output, "--certificate FILE", &options.certificate,
                  "Write a proof of the answer, which snug-check verifies");
}

CertificateFile::CertificateFile(const CommonOptions& options)
    : notes_(notes_for(options)), name_(options.certificate) {
  if (name_ == "-" || (!name_.empty() && name_ == options.output)) {
    throw UsageError("--certificate needs a file of its own");
  }
  if (!name_.empty()) file_.emplace(name_);
}

void CertificateFile::add_to(Report& report, std::vector<AtomicFile*>& files) {
  if (!file_) return;
  const bool none = certificate_.text.empty();
  if (notes_ && !certificate_.missing.empty()) {
    notes_(name_ + (none ? ": not written, there is no proof of " : ": does not prove ") +
           certificate_.missing);
  }
  if (report.json()) {
    JsonWriter& json = report.write();
    json.key("certificate").begin_object().key("file");
    none ? json.null() : json.value(name_);
    json.field("missing", certificate_.missing).end_object();
  }
  if (none) {
    file_.reset();
    system_files::remove(name_.c_str());  // a proof of an earlier answer
    return;
  }
  file_->write(certificate_.text);
  files.push_back(&*file_);
}

}  // namespace snug::command
