#pragma once

namespace snug {

/// A broken contract: the condition as written, and its place.
struct ContractViolation {
  const char* condition;
  const char* file;
  int line;
};

/// Called when a condition of SNUG_EXPECT does not hold. It must not return: throw, or end the process.
using ContractHandler = void (*)(const ContractViolation&);

/// Replaces the handler and returns the one before. The default prints one line and aborts.
ContractHandler set_contract_handler(ContractHandler handler) noexcept;

[[noreturn]] void contract_violated(const char* condition, const char* file, int line);

}  // namespace snug

/// A bug of our own, checked in every build. What a caller, a file or the machine gets wrong is an
/// InputError.
#define SNUG_EXPECT(condition) \
  ((condition) ? static_cast<void>(0) : ::snug::contract_violated(#condition, __FILE__, __LINE__))
