#pragma once

#include <stdexcept>

#include <snug/base/contract.h>

/// While it lives, a broken contract throws BrokenContract.
struct BrokenContract : std::logic_error {
  using std::logic_error::logic_error;
};

class ThrowingContracts {
 public:
  ThrowingContracts()
      : before_(snug::set_contract_handler(
            [](const snug::ContractViolation& v) { throw BrokenContract(v.condition); })) {}
  ~ThrowingContracts() { snug::set_contract_handler(before_); }
  ThrowingContracts(const ThrowingContracts&) = delete;
  ThrowingContracts& operator=(const ThrowingContracts&) = delete;

 private:
  snug::ContractHandler before_;
};
