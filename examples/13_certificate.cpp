// An answer with its proof, which the program snug-check verifies without trusting snug.
//
//   13_certificate A B OUT

#include <cstdio>
#include <exception>
#include <fstream>

#include <snug/snug.h>

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: 13_certificate A B OUT\n");
    return 2;
  }
  try {
    const snug::Surface a = snug::load(argv[1]), b = snug::load(argv[2]);
    const snug::Motion pose = snug::Motion::translation({1.5 * (a.size() + b.size()) / 2, 0, 0});
    snug::Certificate proof;
    const snug::Distance answer = snug::distance(a, b.at(pose), {.relative = 0.01}, {.certificate = &proof});
    std::printf("between %g and %g apart\n", answer.distance.lower, answer.distance.upper);
    if (!proof.missing.empty()) std::printf("the proof does not prove %s\n", proof.missing.c_str());
    std::ofstream(argv[3]) << proof.text;
    std::printf("%zu bytes of proof: snug-check %s\n", proof.text.size(), argv[3]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
