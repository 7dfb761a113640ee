#include "calibration.h"

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <vector>

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#define SNUG_BENCH_AVX2 1
#endif

namespace snug::bench {
namespace {

constexpr int scalar_steps = 400'000, vector_steps = 1'000'000;
// Volatile: else the compiler may move arithmetic out of the timed stretch.
volatile double source = 1, sink;

double scalar_part() {
  double x = source;
  for (int i = 0; i < scalar_steps; ++i) x = x * 0.999 + 0.001;
  return x;
}

#ifdef SNUG_BENCH_AVX2
__attribute__((target("avx2,fma"))) double vector_part() {
  constexpr int chains = 12;
  __m256d x[chains];
  for (int c = 0; c < chains; ++c) x[c] = _mm256_set1_pd(source + c);
  const __m256d a = _mm256_set1_pd(0.999), b = _mm256_set1_pd(0.001);
  for (int i = 0; i < vector_steps / chains; ++i) {
#pragma GCC unroll 12
    for (int c = 0; c < chains; ++c) x[c] = _mm256_fmadd_pd(x[c], a, b);
  }
  __m256d sum = x[0];
  for (int c = 1; c < chains; ++c) sum = _mm256_add_pd(sum, x[c]);
  return _mm256_cvtsd_f64(sum);
}
bool has_vector_part() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }
#else
double vector_part() { return 0; }
bool has_vector_part() { return false; }
#endif

double memory_part(const std::vector<double>& data) {
  double sum[8] = {};
  for (std::size_t i = 0; i < data.size(); i += 8) {
    for (std::size_t k = 0; k < 8; ++k) sum[k] += data[i + k];
  }
  return sum[0] + sum[1] + sum[2] + sum[3] + sum[4] + sum[5] + sum[6] + sum[7];
}

template <class Part>
double seconds_of(Part part) {
  const double start = processor_seconds();
  sink = part();
  return processor_seconds() - start;
}

Calibration& best() {
  static Calibration value;
  return value;
}

}  // namespace

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Calibration calibrate() {
  static const std::vector<double> data(std::size_t{8} << 20, 1.0);
  Calibration result;
  const double scalar = seconds_of(scalar_part);
  result.scalar_gflops = 2e-9 * scalar_steps / scalar;
  result.seconds = scalar;
  if (has_vector_part()) {
    const double vector = seconds_of(vector_part);
    result.vector_gflops = 8e-9 * vector_steps / vector;
    result.seconds += vector;
  }
  const double memory = seconds_of([] { return memory_part(data); });
  result.memory_gb_per_s = 8e-9 * static_cast<double>(data.size()) / memory;
  result.seconds += memory;

  if (best().seconds == 0 || result.seconds < best().seconds) best() = result;
  return result;
}

const Calibration& best_calibration() {
  static const bool warmed = [] {
    for (int i = 0; i < 10; ++i) static_cast<void>(calibrate());
    return true;
  }();
  static_cast<void>(warmed);
  return best();
}

}  // namespace snug::bench
