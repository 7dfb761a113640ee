#include <snug/io/element_text.h>

#include <snug/io/number.h>

namespace snug {

double read_coordinate(const TextCursor& at, std::size_t vertex, std::string_view word) {
  const ParsedReal real = parse_real(word);
  if (real.fault != NumberFault::none) {
    const std::string vertex_name = "vertex " + std::to_string(vertex);
    if (word.empty()) at.fail(vertex_name + " has fewer than three coordinates");
    at.fail(vertex_name + ": " + in_quotes(word) + ' ' + std::string(describe(real.fault)));
  }
  return real.value;
}

void expect_room(const TextCursor& at, std::size_t count, const char* what) {
  if (count >= most_elements) {
    at.fail("more than " + std::to_string(most_elements) + ' ' + what + ": split the mesh");
  }
}

void expect_elements(const TextCursor& at, std::size_t vertices, std::size_t faces) {
  if (vertices == 0) at.fail_everywhere("the file has no vertices");
  if (faces == 0) at.fail_everywhere("the file has no faces");
}

void append_point(std::string& text, const Point3& point) {
  append_real(text, point.x);
  text += ' ';
  append_real(text, point.y);
  text += ' ';
  append_real(text, point.z);
}

}  // namespace snug
