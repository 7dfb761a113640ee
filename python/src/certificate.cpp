#include "certificate.h"

namespace snug::python {

CertificateFile::CertificateFile(const py::object& path) {
  if (path.is_none()) return;
  path_ = py::module_::import("os").attr("fspath")(path).cast<std::string>();
  file_ = py::module_::import("snug._convert").attr("WholeFile")(*path_);
}

void CertificateFile::write() const {
  if (!path_) return;
  const bool none = certificate_.text.empty();
  none ? file_.attr("leave")() : file_.attr("write")(certificate_.text);
  if (certificate_.missing.empty()) return;
  const std::string text =
      *path_ + (none ? ": not written, there is no proof of " : ": does not prove ") + certificate_.missing;
  if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

}  // namespace snug::python
