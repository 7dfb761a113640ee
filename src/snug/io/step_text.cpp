#include <snug/io/step_text.h>

#include <cstdint>

#include <snug/io/utf8.h>
#include <support/number.h>

namespace snug {
namespace {

void append_hex(std::string& text, std::uint32_t number, int digits) {
  for (int k = digits - 1; k >= 0; --k) text += "0123456789ABCDEF"[(number >> (4 * k)) & 15u];
}

}  // namespace

void append_step_real(std::string& text, double x) {
  const std::size_t begin = text.size();
  append_real(text, x);
  std::size_t end = begin;
  bool point = false;
  for (; end < text.size() && text[end] != 'e'; ++end) point = point || text[end] == '.';
  if (end < text.size()) text[end] = 'E';
  if (!point) text.insert(end, 1, '.');
}

std::string step_string(std::string_view utf8) {
  std::string text = "'";
  for (const char32_t c : code_points(utf8)) {
    if (c == U'\'' || c == U'\\') {
      text.append(2, static_cast<char>(c));
    } else if (c >= 32 && c < 127) {
      text += static_cast<char>(c);
    } else if (c <= 0xffff) {
      text += "\\X2\\";
      append_hex(text, c, 4);
      text += "\\X0\\";
    } else {
      text += "\\X4\\";
      append_hex(text, c, 8);
      text += "\\X0\\";
    }
  }
  return text + "'";
}

void StepText::begin(const std::string& name, std::string_view schema) {
  text_ = "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME(" + step_string(name) +
          ",'',(''),(''),'snug','snug','');\nFILE_SCHEMA(('";
  text_ += schema;
  text_ += "'));\nENDSEC;\nDATA;\n";
}

std::size_t StepText::point(const Point3& p) { return triple("CARTESIAN_POINT('',(", p.x, p.y, p.z); }
std::size_t StepText::direction(const Vector3& v) { return triple("DIRECTION('',(", v.x, v.y, v.z); }

std::size_t StepText::triple(std::string_view entity, double x, double y, double z) {
  const auto append_numbers = [&] {
    append_step_real(text_, x);
    text_ += ',';
    append_step_real(text_, y);
    text_ += ',';
    append_step_real(text_, z);
    text_ += "))";
  };
  return add(entity, append_numbers);
}

void StepText::list(std::string& list, std::size_t number) {
  if (!list.empty()) list += ',';
  list += '#';
  list += std::to_string(number);
}

std::string StepText::finish() {
  text_ += "ENDSEC;\nEND-ISO-10303-21;\n";
  return std::move(text_);
}

}  // namespace snug
