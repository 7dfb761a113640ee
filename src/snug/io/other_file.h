#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace snug {

/// The bytes of another file, by its path relative to the folder of the one that names it. Empty: there are none.
using OtherFiles = std::function<std::string(const std::string& path)>;

/// The path by which a file names another one, without the escapes of URIs.
///
/// Errors:    InputError (unreadable) "name: what: ..." for an absolute path, one that leads out of the folder by "..",
///            addresses of the network, NUL. Symbolic links are not looked at.
[[nodiscard]] std::string path_inside(std::string_view uri, const std::string& name, const std::string& what);

/// The bytes behind "data:...;base64,".
///
/// Errors:    InputError (unreadable), likewise, for another encoding and for text that is no base64.
[[nodiscard]] std::string data_of_uri(std::string_view uri, const std::string& name, const std::string& what);
/// Such a text.
void append_base64(std::string& text, std::string_view bytes);

}  // namespace snug
