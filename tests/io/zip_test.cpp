#include <snug/io/zip.h>

#include <algorithm>
#include <random>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include <support/binary.h>
#include <testing/files.h>

namespace snug::zip_test {
namespace {

using testing::unreadable;

std::string archive_of(const std::string& path, const std::string& bytes) {
  ZipWriter writer;
  writer.add("first", "");
  writer.add(path, bytes);
  return writer.finish("out.zip");
}
std::string read_from(const std::string& archive, const std::string& path) {
  const std::string name = "in.zip";
  return ZipArchive(archive, name).read(path);
}
std::string refusal(const std::string& archive, const std::string& path) {
  return unreadable([&] { static_cast<void>(read_from(archive, path)); });
}

TEST(zip, what_is_written_is_read_back) {
  std::mt19937 random(7);
  std::string noise, text;
  for (int i = 0; i < 100'000; ++i) noise += static_cast<char>(random());
  for (int i = 0; i < 100'000; ++i) text += "<vertex x=\"" + std::to_string(random() % 1000) + "\"/>\n";
  for (const std::string& bytes : {std::string(), std::string("a"), noise, text}) {
    EXPECT_EQ(read_from(archive_of("3D/a.model", bytes), "3D/a.model"), bytes);
  }
  EXPECT_LT(archive_of("a", text).size(), text.size() / 4);
  EXPECT_EQ(archive_of("a", text), archive_of("a", text));
}

TEST(zip, how_bytes_are_cut_makes_no_difference) {
  std::mt19937 random(3);
  std::string text;
  for (int i = 0; i < 60'000; ++i) text += "<vertex x=\"" + std::to_string(random() % 1000) + "\"/>\n";
  for (const std::size_t most : {std::size_t{1}, std::size_t{70}, std::size_t{100'000}}) {
    ZipWriter writer;
    writer.add("first", "");
    writer.add("a", [&](const ZipWriter::Append& append) {
      for (std::size_t at = 0; at < text.size();) {
        const std::size_t size = std::min(text.size() - at, 1 + random() % most);
        append(std::string_view(text).substr(at, size));
        at += size;
      }
    });
    EXPECT_TRUE(writer.finish("out.zip") == archive_of("a", text));
  }
}

TEST(zip, every_truncation_is_refused) {
  const std::string whole = archive_of("a", std::string(1000, 'x') + "some text");
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_TRUE(refusal(whole.substr(0, size), "a").starts_with("in.zip: ZIP: ")) << size;
  EXPECT_EQ(read_from(whole + std::string(22, '\0'), "a").size(), 1009u);  // a comment may follow
}

TEST(zip, damage_is_refused) {
  const std::string whole =
      archive_of("a", "some text, some text, some text, some text, some text, some text");
  std::size_t read = 0;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const int bit : {0, 3, 7}) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit));
      try {
        const std::string bytes = read_from(damaged, "a");
        EXPECT_EQ(bytes, read_from(whole, "a"));
        ++read;
      } catch (const InputError& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with("in.zip: ZIP: "));
      }
    }
  }
  EXPECT_LT(read, whole.size() * 2);  // dates, versions and the like
}

TEST(zip, bombs_are_refused) {
  const std::string bomb = archive_of("a", std::string(20'000'000, '\0'));
  ASSERT_LT(bomb.size(), 25'000u);
  EXPECT_EQ(refusal(bomb, "a"),
            "in.zip: ZIP: 'a' would unpack to 20000000 bytes, more than 100 times the file");
  // The directory promises less than there is.
  std::string liar = archive_of("a", std::string(5'000'000, '\0'));
  const std::size_t entry = liar.rfind("PK\1\2");
  std::string small;
  append_binary(small, std::uint32_t{1000});
  liar.replace(entry + 24, 4, small);
  EXPECT_EQ(refusal(liar, "a"), "in.zip: ZIP: 'a' does not unpack: the file is damaged");
}

TEST(zip, names_the_file_that_is_not_there) {
  EXPECT_EQ(refusal(archive_of("a", "x"), "b"), "in.zip: ZIP: no file 'b'");
}

}  // namespace
}  // namespace snug::zip_test
