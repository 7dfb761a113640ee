#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace snug {

/// Calls visit(row) for the rows of numbers that a file of points or rays holds; `visit` says whether they
/// are good ones.
///
/// Reads:     text, a row a line, numbers separated by blanks, or by one comma or semicolon each; blank lines
///            and those that begin with # are skipped, and so is a first line without any number, the heads
///            of the columns. And arrays of NumPy (.npy) with as many columns as rows have numbers, float32
///            or float64 of both byte orders, in the order of C or Fortran. Which of the two follows from the
///            first bytes.
/// Guarantee: numbers are the nearest doubles; they may be infinite or none at all.
/// Errors:    InputError (unreadable) "name:line: expected" or "name: row i: expected" for a row that has none
///            of the `widths`, or that is not good; the same for arrays of another shape or type, and truncated
///            ones.
/// Cost:      linear in the bytes.
void for_each_row(std::string_view bytes, const std::string& name, std::initializer_list<std::size_t> widths,
                  const std::string& expected, const std::function<bool(std::span<const double>)>& visit);

}  // namespace snug
