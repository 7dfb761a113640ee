#include <snug/io/json.h>

#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include <testing/files.h>

namespace snug::json_test {
namespace {

using testing::unreadable;

/// The same value by another reader.
nlohmann::json other(const Json& value) {
  switch (value.kind) {
    case Json::Kind::null:
      return nullptr;
    case Json::Kind::boolean:
      return value.truth;
    case Json::Kind::number:
      return value.number;
    case Json::Kind::text:
      return std::string(value.text);
    case Json::Kind::array: {
      nlohmann::json list = nlohmann::json::array();
      for (const Json& item : value.items) list.push_back(other(item));
      return list;
    }
    default: {
      nlohmann::json object = nlohmann::json::object();
      for (std::size_t i = 0; i < value.names.size(); ++i) {
        object[std::string(value.names[i])] = other(value.items[i]);
      }
      return object;
    }
  }
}

TEST(json, reads_what_another_reader_reads) {
  for (const char* text :
       {"null", " true ", "false\n", "-1.5e3", "0", "\"a b\"", "[]", "{}", "[1, [2, [3]], {\"a\": null}]",
        "{\"a\": {\"b\": [true, false]}, \"c\": \"\"}", "\t[\r\n 1 ]", "{\"a\": 1, \"a\": 2}"}) {
    EXPECT_EQ(other(parse_json(text, "t")), nlohmann::json::parse(text)) << text;
  }
}

TEST(json, refuses_what_another_reader_refuses) {
  std::vector<std::string> texts{"",      "[1,]",  "{\"a\" 1}", "{1: 2}",   "[1 2]", "nul",
                                 "\"a",   "\"a\\", "[",         "{",        "[1] 2", "+1",
                                 "1e999", "--1",   "]",         "{\"a\":}", "'a'",   "NaN"};
  for (const std::string& text : texts) {
    EXPECT_FALSE(nlohmann::json::accept(text) && text != "1e999") << text;
    const std::string message = unreadable([&] { static_cast<void>(parse_json(text, "t")); });
    EXPECT_EQ(message.substr(0, 14), "t: JSON, byte ") << message;
  }
  EXPECT_EQ(unreadable([] { static_cast<void>(parse_json(std::string("[1]\0", 4), "t")); }),
            "t: JSON, byte 3: more text follows the value");
}

TEST(json, finds_members_and_whole_numbers) {
  const Json value =
      parse_json("{\"a\": 1, \"b\": -1, \"c\": 1.5, \"a\": 7, \"d\": 1e300, \"e\": \"1\"}", "t");
  EXPECT_EQ(value.find("a")->integer(), 7u);
  for (const char* key : {"b", "c", "d", "e"}) EXPECT_FALSE(value.find(key)->integer()) << key;
  EXPECT_EQ(value.find("f"), nullptr);
  EXPECT_EQ(value.find("a")->find("a"), nullptr);
}

TEST(json, nesting_is_bounded) {
  EXPECT_EQ(parse_json(std::string(100, '[') + std::string(100, ']'), "t").kind, Json::Kind::array);
  EXPECT_EQ(unreadable([] { static_cast<void>(parse_json(std::string(1'000'000, '['), "t")); }),
            "t: JSON, byte 101: values are nested deeper than 100");
}

}  // namespace
}  // namespace snug::json_test
