#include <support/contract.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>

namespace snug {
namespace {

void print_and_abort(const ContractViolation& violation) {
  std::fprintf(stderr, "snug: contract broken: %s (%s:%d)\n", violation.condition, violation.file,
               violation.line);
  std::abort();
}

std::atomic<ContractHandler> current_handler{&print_and_abort};

}  // namespace

ContractHandler set_contract_handler(ContractHandler handler) noexcept {
  return current_handler.exchange(handler ? handler : &print_and_abort);
}

void contract_violated(const char* condition, const char* file, int line) {
  current_handler.load()(ContractViolation{condition, file, line});
  std::abort();
}

}  // namespace snug
