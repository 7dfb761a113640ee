#ifdef _WIN32

#include <io.h>
#include <windows.h>

// After it, whose words it uses.
#include <shellapi.h>

#include <cstdint>

#include "process.h"
#include "progress_bar.h"

namespace snug::command::process {
namespace {

constexpr DWORD grace = 300;  // milliseconds

// In a thread of its own.
BOOL WINAPI note_interrupt(DWORD) {
  if (!stop_requested.exchange(true)) ::Sleep(grace);
  end_interrupted();
}

[[gnu::constructor(101)]] void install_handlers() { ::SetConsoleCtrlHandler(note_interrupt, TRUE); }

std::string narrow(const wchar_t* text) {
  const int count = ::WideCharToMultiByte(CP_UTF8, 0, text, -1, nullptr, 0, nullptr, nullptr);
  if (count <= 0) return {};
  std::string result(static_cast<std::size_t>(count), '\0');
  ::WideCharToMultiByte(CP_UTF8, 0, text, -1, result.data(), count, nullptr, nullptr);
  result.pop_back();  // the zero at the end
  return result;
}

HANDLE handle_of(int descriptor) {
  return reinterpret_cast<HANDLE>(::_get_osfhandle(descriptor));  // NOLINT: Windows declares it as a number
}

}  // namespace

// Those of main() are in the code page of the system, which lacks most characters.
std::vector<std::string> arguments(int, char**) {
  ::SetConsoleOutputCP(CP_UTF8);
  int count = 0;
  wchar_t** const words = ::CommandLineToArgvW(::GetCommandLineW(), &count);
  std::vector<std::string> result;
  for (int i = 1; i < count; ++i) result.push_back(narrow(words[i]));
  ::LocalFree(words);
  return result;
}

std::filesystem::path folder() {
  std::wstring name(32768, L'\0');  // the longest that Windows has
  name.resize(::GetModuleFileNameW(nullptr, name.data(), static_cast<DWORD>(name.size())));
  return std::filesystem::path(name).parent_path();
}

bool is_terminal(int descriptor) {
  DWORD mode = 0;
  return ::GetConsoleMode(handle_of(descriptor), &mode) != 0;
}

bool can_read_now(int descriptor) {
  const HANDLE handle = handle_of(descriptor);
  DWORD there = 0;
  if (::GetFileType(handle) != FILE_TYPE_PIPE) return ::WaitForSingleObject(handle, 0) == WAIT_OBJECT_0;
  return !::PeekNamedPipe(handle, nullptr, 0, nullptr, &there, nullptr) || there > 0;  // at its end, too
}

void end(int status) noexcept { ::_exit(status); }

// The C library keeps their numbers free.
void hold_standard_descriptors() noexcept {}
void load_what_unwinds() noexcept {}

void* load_library(const std::filesystem::path& file) { return ::LoadLibraryW(file.c_str()); }
void* symbol_of(void* library, const char* name) {
  return reinterpret_cast<void*>(::GetProcAddress(static_cast<HMODULE>(library), name));
}

}  // namespace snug::command::process

#endif
