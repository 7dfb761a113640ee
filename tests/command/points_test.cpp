// Points in and out as other programs hold them: CSV, arrays of NumPy, PLY.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "run_snug.h"

namespace snug::testing::points_test {
namespace {

using nlohmann::json;

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

void put(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

bool has_numpy() { return std::system("/usr/bin/python3 -c 'import numpy' 2> /dev/null") == 0; }

// A program for python3; does it end well?
bool python(const TemporaryFolder& folder, const std::string& program) {
  put(folder.file("program.py"), "import json, numpy as n\n" + program);
  return std::system(("/usr/bin/python3 " + folder.file("program.py")).c_str()) == 0;
}

const std::string three = "0 0 5\n1 2 3\n-4 0.1 0\n";

TEST(points, come_from_csv_and_numpy_as_from_lines) {
  const TemporaryFolder folder;
  put(folder.file("p.txt"), three);
  put(folder.file("p.csv"), "x;y;z\r\n0;0;5\r\n1;2;3\r\n-4;0.1;0\r\n");
  const auto answer = [&](const char* name) {
    const Outcome outcome = run_snug({"closest", model("star.obj"), "--points", folder.file(name), "--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(outcome.out)["results"];
  };
  EXPECT_EQ(answer("p.csv"), answer("p.txt"));
  EXPECT_EQ(answer("p.txt").size(), 3u);
  if (!has_numpy()) GTEST_SKIP() << "no numpy";
  ASSERT_TRUE(python(folder, "a = n.loadtxt('" + folder.file("p.txt") + "')\n" + "n.save('" +
                                 folder.file("c.npy") + "', a)\n" + "n.save('" + folder.file("f.npy") +
                                 "', n.asfortranarray(a))\n" + "n.save('" + folder.file("b.npy") +
                                 "', a.astype('>f8'))\n" + "n.save('" + folder.file("i.npy") +
                                 "', a.astype(int))\n"));
  for (const char* name : {"c.npy", "f.npy", "b.npy"}) EXPECT_EQ(answer(name), answer("p.txt")) << name;
  const Outcome refused = run_snug({"closest", model("star.obj"), "--points", folder.file("i.npy")});
  EXPECT_EQ(refused.status, 3);
  EXPECT_NE(refused.err.find("a.astype(float)"), std::string::npos) << refused.err;
}

TEST(points, rays_come_from_csv_and_numpy) {
  const TemporaryFolder folder;
  put(folder.file("r.txt"), "0 0 9 0 0 -1\n0.1 0.2 9 0 0 -1\n");
  put(folder.file("r.csv"), "ox,oy,oz,dx,dy,dz\n0,0,9,0,0,-1\n0.1,0.2,9,0,0,-1\n");
  const auto answer = [&](const char* name) {
    const Outcome outcome =
        run_snug({"ray", model("star.obj"), "--rays", folder.file(name), "--all", "--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(outcome.out)["results"];
  };
  EXPECT_EQ(answer("r.csv"), answer("r.txt"));
  if (!has_numpy()) GTEST_SKIP() << "no numpy";
  ASSERT_TRUE(
      python(folder, "n.save('" + folder.file("r.npy") + "', n.loadtxt('" + folder.file("r.txt") + "'))\n"));
  EXPECT_EQ(answer("r.npy"), answer("r.txt"));
}

TEST(points, tables_hold_the_numbers_of_the_document) {
  const TemporaryFolder folder;
  put(folder.file("p.txt"), three);
  const std::string star = model("star.obj"), lines = folder.file("p.txt");
  for (const char* name : {"c.json", "c.npy", "c.ply", "c.csv"}) {
    const Outcome outcome =
        run_snug({"closest", star, "--points", lines, "-o", folder.file(name), "--quiet"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    if (name[2] != 'j') {
      EXPECT_EQ(outcome.out, folder.file(name) + ": 3 closest points\n");
    }
    EXPECT_EQ(
        run_snug({"eval", star, "--samples", "3", "-o", folder.file(std::string("e") + (name + 1))}).status,
        0);
  }
  if (!has_numpy()) GTEST_SKIP() << "no numpy";
  EXPECT_TRUE(python(folder, "import os\nos.chdir('" + folder.file("") + "')" + R"(
def ply(path):
    head, body = open(path, 'rb').read().split(b'end_header\n', 1)
    names = [l.split()[1:] for l in head.decode().split('\n') if l.startswith('property')]
    types = {'double': '<f8', 'uint': '<u4', 'uchar': '|u1'}
    return n.frombuffer(body, [(name, types[t]) for t, name in names])
def same(a, b):
    assert a.dtype.names == b.dtype.names and len(a) == len(b), (a.dtype.names, b.dtype.names)
    for k in a.dtype.names: assert n.array_equal(a[k], b[k], equal_nan=True), k
for c in 'ce':
    a = n.load(c + '.npy', mmap_mode='r')
    same(a, ply(c + '.ply'))
    same(a, n.genfromtxt(c + '.csv', delimiter=',', names=True))
    d = json.load(open(c + '.json'))
    rows = d['results' if c == 'c' else 'points']
    assert len(a) == len(rows) > 0
    for i, r in enumerate(rows):
        p = r['point']
        assert [a['x'][i], a['y'][i], a['z'][i], a['error'][i], a['u'][i], a['v'][i], a['face'][i]] == p + [r['error'], r['u'], r['v'], r['face']]
        if c == 'c': assert [a['distance_lower'][i], a['distance_upper'][i]] == r['distance'] and a['complete'][i] == (r['outcome'] == 'complete')
        else:
            assert [a['du_x'][i], a['dv_z'][i]] == [r['tangents'][0][0], r['tangents'][1][2]]
            assert (r['normal'] is None and n.isnan(a['normal_x'][i])) or a['normal_y'][i] == r['normal'][1]
)"));
}

TEST(points, tables_have_the_columns_of_what_was_asked) {
  const TemporaryFolder folder;
  put(folder.file("p.txt"), three);
  const auto head = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"-o", folder.file("a.csv"), "--json"});
    const Outcome outcome = run_snug(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(json::parse(outcome.out).contains("count"));  // the document stays on standard output
    const std::string file = contents(folder.file("a.csv"));
    return file.substr(0, file.find('\n'));
  };
  EXPECT_EQ(head({"closest", model("star.obj"), "--points", folder.file("p.txt"), "--scheme", "catmark",
                  "--signed"}),
            "x,y,z,error,distance_lower,distance_upper,signed_lower,signed_upper,face,corner,u,v,complete");
  put(folder.file("l.obj"), "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 1\nl 1 2 3 4\n");
  EXPECT_EQ(head({"eval", folder.file("l.obj")}), "edge,t,x,y,z,error,tangent_x,tangent_y,tangent_z");
}

TEST(points, other_endings_are_usage_errors) {
  const TemporaryFolder folder;
  put(folder.file("p.txt"), three);
  const std::string star = model("star.obj");
  EXPECT_EQ(run_snug({"closest", star, "--points", folder.file("p.txt"), "-o", folder.file("a.npz")}).status,
            2);
  EXPECT_EQ(run_snug({"ray", star, "--rays", folder.file("p.txt"), "-o", folder.file("a.npy")}).status, 2);
  // A table that is not whole is not there.
  put(folder.file("bad.txt"), "0 0 1\n0 0 x\n");
  EXPECT_EQ(
      run_snug({"closest", star, "--points", folder.file("bad.txt"), "-o", folder.file("a.npy")}).status, 3);
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.npy")));
}

}  // namespace
}  // namespace snug::testing::points_test
