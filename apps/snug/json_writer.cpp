#include "json_writer.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <support/contract.h>
#include <support/error.h>

#include "messages.h"

namespace snug::command {

JsonWriter::JsonWriter(std::function<void(std::string_view)> sink, Lines lines)
    : sink_(std::move(sink)), lines_(lines) {}

void JsonWriter::separate() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (has_items_.empty()) return;
  if (has_items_.back()) buffer_ += ',';
  has_items_.back() = true;
  if (lines_ == Lines::many && has_items_.size() <= 2)
    buffer_ += '\n';  // a line for each entry of the document and of its lists
}

void JsonWriter::open(char bracket) {
  separate();
  buffer_ += bracket;
  has_items_.push_back(false);
}

void JsonWriter::close(char bracket) {
  SNUG_EXPECT(!has_items_.empty() && !after_key_);
  const bool items = has_items_.back();
  has_items_.pop_back();
  if (lines_ == Lines::many && items && has_items_.size() <= 1) buffer_ += '\n';
  buffer_ += bracket;
  flush_if_long();
}

JsonWriter& JsonWriter::begin_object() { return open('{'), *this; }
JsonWriter& JsonWriter::end_object() { return close('}'), *this; }
JsonWriter& JsonWriter::begin_array() { return open('['), *this; }
JsonWriter& JsonWriter::end_array() { return close(']'), *this; }

JsonWriter& JsonWriter::raw(std::string_view text) {
  separate();
  buffer_ += text;
  return *this;
}

JsonWriter& JsonWriter::spliced(std::string_view document) {
  raw(document);
  flush_if_long();
  return *this;
}

JsonWriter& JsonWriter::key(std::string_view name) {
  value(name);
  buffer_ += ": ";
  after_key_ = true;
  return *this;
}

JsonWriter& JsonWriter::value(double number) {
  if (!std::isfinite(number)) {
    throw InputError(InputProblem::unrepresentable, "a number in the answer does not fit a double");
  }
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, number).ptr;
  return raw({text, static_cast<std::size_t>(end - text)});
}

JsonWriter& JsonWriter::value(std::string_view text) {
  separate();
  std::string mended;  // names of files need not be UTF-8
  if (std::any_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x80; })) {
    text = mended = as_utf8(text);
  }
  buffer_ += '"';
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      buffer_ += '\\';
      buffer_ += c;
    } else if (byte < 0x20) {
      constexpr char digits[] = "0123456789abcdef";
      buffer_ += "\\u00";
      buffer_ += digits[byte >> 4];
      buffer_ += digits[byte & 15];
    } else {
      buffer_ += c;
    }
  }
  buffer_ += '"';
  return *this;
}

JsonWriter& JsonWriter::value(const Vector3& v) {
  return begin_array().value(v.x).value(v.y).value(v.z).end_array();
}

JsonWriter& JsonWriter::value(const Point3& p) { return value(p - Point3{}); }

void JsonWriter::flush_if_long() {
  if (buffer_.size() >= 65536) flush();
}

void JsonWriter::flush() {
  sink_(buffer_);
  buffer_.clear();
}

void JsonWriter::finish() {
  SNUG_EXPECT(has_items_.empty());
  if (lines_ == Lines::many) buffer_ += '\n';
  flush();
}

}  // namespace snug::command
