#pragma once

#include <hwy/targets.h>

#include <cstdint>

namespace snug::testing {

/// Runs work under every instruction set that was compiled and that this processor has; puts back what was
/// chosen.
class EachInstructionSet {
 public:
  EachInstructionSet() = default;
  EachInstructionSet(const EachInstructionSet&) = delete;
  EachInstructionSet& operator=(const EachInstructionSet&) = delete;
  ~EachInstructionSet() { use(0); }
  template <class Work>
  void run(const Work& work) const {
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
      use(target);
      work(hwy::TargetName(target));
    }
  }

 private:
  static void use(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

}  // namespace snug::testing
