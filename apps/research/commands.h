#pragma once

#include <apps/snug/common.h>

/// The commands of snug-research.
namespace snug::command {

[[nodiscard]] Command independence_command();
[[nodiscard]] Command table_command();
[[nodiscard]] Command weights_command();
[[nodiscard]] Command fit_command();

[[nodiscard]] Command leaves_command();      ///< table-5-1
[[nodiscard]] Command creation_command();    ///< table-5-2
[[nodiscard]] Command rooms_command();       ///< table-5-3
[[nodiscard]] Command volumes_command();     ///< volumes
[[nodiscard]] Command rates_command();       ///< rates
[[nodiscard]] Command tightness_command();   ///< tightness
[[nodiscard]] Command pair_test_command();   ///< pair-test
[[nodiscard]] Command prism_command();       ///< prism
[[nodiscard]] Command bounds_command();      ///< bounds
[[nodiscard]] Command older_rule_command();  ///< subdivide

}  // namespace snug::command
