#include <snug/io/xml.h>

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <testing/files.h>

namespace snug::xml_test {
namespace {

using testing::unreadable;
using Event = XmlReader::Event;

// "<a><b/></a>" as "a(b())".
std::string walked(const std::string& text) {
  const std::string name = "in.xml";
  XmlReader xml(text, name);
  std::string result;
  while (true) {
    const Event event = xml.next();
    if (event == Event::done) return result;
    if (event == Event::begin) result += std::string(xml.element()) + '(';
    if (event == Event::end) result += ')';
  }
}
std::string refusal(const std::string& text) {
  return unreadable([&] { static_cast<void>(walked(text)); });
}

TEST(xml, elements_begin_and_end) {
  EXPECT_EQ(walked("<a><b/></a>"), "a(b())");
  EXPECT_EQ(
      walked(
          "<?xml version='1.0'?>\n<!-- <x> -- -->\n<p:a >text<b x='>'></b ><![CDATA[<c>]]></p:a>\n<!---->"),
      "a(b())");
}

TEST(xml, faults_name_the_line) {
  EXPECT_EQ(refusal("<a>\n<b>\n</a>"), "in.xml:3: XML: 'a' ends where 'b' is open");
  EXPECT_EQ(refusal("<a>\n<b>"), "in.xml:2: XML: 'b' has no end: the file is truncated");
  EXPECT_EQ(refusal("</a>"), "in.xml:1: XML: 'a' ends where nothing is open");
  EXPECT_EQ(refusal("<a/><b/>"), "in.xml:1: XML: a second element beside the first");
  EXPECT_EQ(refusal("<a/>x"), "in.xml:1: XML: text outside of all elements");
  EXPECT_EQ(refusal("<a><!-- "), "in.xml:1: XML: a comment has no end: the file is truncated");
  EXPECT_EQ(refusal("<a x=1/>"), "in.xml:1: XML: the value of 'x' is not in quotes");
  EXPECT_EQ(refusal("<a x/>"), "in.xml:1: XML: 'x' has no value");
  EXPECT_EQ(refusal("<a x='1"), "in.xml:1: XML: the value of 'x' has no end");
  EXPECT_EQ(refusal("<a"), "in.xml:1: XML: a tag has no end: the file is truncated");
  EXPECT_EQ(refusal("< a/>"), "in.xml:1: XML: a name is missing");
  EXPECT_EQ(refusal("<a/ >"), "in.xml:1: XML: the tag 'a' has no '>'");
  EXPECT_EQ(refusal("  "), "in.xml:1: XML: no element");
}

TEST(xml, document_types_are_refused) {
  EXPECT_EQ(refusal("<!DOCTYPE lolz [<!ENTITY lol \"lol\"><!ENTITY lol2 \"&lol;&lol;\">]><a b='&lol2;'/>"),
            "in.xml:1: XML: a document type, as in <!DOCTYPE>: entities are not read; take it out");
}

TEST(xml, attributes_have_their_entities_replaced) {
  const std::string
      name = "in.xml",
      text =
          "<a n='&lt;&amp;&quot;&apos;&gt;&#65;&#x20AC;&#x1F600;' p:m='no' x=' 1.5e3' k=\"12\" bad='&lol;'/>";
  XmlReader xml(text, name);
  EXPECT_EQ(xml.next(), Event::begin);
  EXPECT_EQ(xml.text("n"), "<&\"'>A\xE2\x82\xAC\xF0\x9F\x98\x80");
  EXPECT_EQ(xml.text("m"), std::nullopt);
  EXPECT_EQ(xml.count("k"), 12u);
  EXPECT_EQ(unreadable([&] { static_cast<void>(xml.text("bad")); }),
            "in.xml:1: XML: '&lol' is no entity that is read");
  EXPECT_EQ(unreadable([&] { static_cast<void>(xml.number("z")); }), "in.xml:1: 'a' has no 'z'");
  EXPECT_EQ(unreadable([&] { static_cast<void>(xml.count("n")); }),
            "in.xml:1: n: '&lt;&amp;&quot;&apos;&gt;&#65;&#x20AC;&#...' is not a whole number >= 0");
  EXPECT_EQ(unreadable([&] { static_cast<void>(numbers_of(xml, "v", "1 2 x", 3)); }),
            "in.xml:1: v: 'x' is not a number");
  EXPECT_EQ(unreadable([&] { static_cast<void>(numbers_of(xml, "v", "1 2", 3)); }),
            "in.xml:1: v has 2 numbers, not 3");
}

TEST(xml, children_are_visited_and_skipped) {
  const std::string name = "in.xml", text = "<a><b><c/></b><d/><b/></a>";
  XmlReader xml(text, name);
  EXPECT_EQ(xml.next(), Event::begin);
  std::vector<std::string> met;
  xml.each_child([&] {
    met.emplace_back(xml.element());
    xml.skip();
  });
  EXPECT_EQ(met, (std::vector<std::string>{"b", "d", "b"}));
  EXPECT_EQ(xml.next(), Event::done);
}

TEST(xml, nesting_may_be_deep) {
  const std::size_t depth = 100'000;
  std::string text;
  for (std::size_t i = 0; i < depth; ++i) text += "<a>";
  for (std::size_t i = 0; i < depth; ++i) text += "</a>";
  EXPECT_EQ(walked(text).size(), 3 * depth);
}

}  // namespace
}  // namespace snug::xml_test
