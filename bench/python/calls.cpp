// The loops of bench/python/run in C++: seconds a call of collide, and seconds of the batches, on one line of JSON.
//
//   bench_python_calls A.obj B.obj CALLS POSES POINTS

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

#include <snug/snug.h>

namespace {

template <class Work>
double seconds(const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  const snug::Surface a = snug::load(argv[1]), b = snug::load(argv[2]);
  const int calls = std::atoi(argv[3]), pose_count = std::atoi(argv[4]), point_count = std::atoi(argv[5]);
  const snug::CollideOptions options{
      .tolerance = 0.1 / 100 * a.size(), .witness = snug::WitnessKind::none, .measure = false};
  const std::array<double, 12> far{1, 0, 0, 30, 0, 1, 0, 0, 0, 0, 1, 0};
  const auto ask = [&] {
    return snug::collide(a, b.at(snug::Motion::from_3x4(far)), options).distance.lower;
  };
  double sum = ask();
  const std::clock_t begin = std::clock();  // of the processor, as in bench/python/run
  for (int i = 0; i < calls; ++i) sum += ask();
  const double call = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  const double batch = seconds([&] {
    std::vector<snug::PosePair> poses;
    for (int i = 0; i < pose_count; ++i) {
      std::array<double, 12> pose = far;
      pose[3] = 4.0 * i / pose_count - 2;
      poses.push_back({.a = {}, .b = snug::Motion::from_3x4(pose)});
    }
    sum += snug::collide(a, b, poses, {.tolerance = options.tolerance}).back().distance.lower;
  });
  std::vector<snug::Point3> points;
  for (int i = 0; i < point_count; ++i) points.push_back({2.0 * i / point_count - 1, 0.75, 0.5});
  const double closest = seconds([&] { sum += snug::closest_point(a, points).back().distance.lower; });
  std::printf("{\"call\": %.9g, \"batch\": %.9g, \"closest\": %.9g, \"sum\": %.17g}\n", call / calls, batch,
              closest, sum);
}
