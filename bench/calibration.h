#pragma once

namespace snug::bench {

/// How fast the machine was at one moment: a fixed amount of arithmetic and of reading, timed.
struct Calibration {
  double seconds = 0;          ///< processor time for all three parts
  double scalar_gflops = 0;    ///< one dependent chain of multiplications and additions
  double vector_gflops = 0;    ///< twelve chains of four doubles, fused (AVX2); 0 where the machine has none
  double memory_gb_per_s = 0;  ///< summing 64 MiB
};

/// Processor time of this process so far, all its threads together.
[[nodiscard]] double processor_seconds();

/// Times the three parts once, in some 10 ms.
[[nodiscard]] Calibration calibrate();

/// The fastest of all calls of calibrate() in this process; other times are relative to its time.
/// Cost:      on first use ten calls.
[[nodiscard]] const Calibration& best_calibration();

}  // namespace snug::bench
