#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include <snug/bounds/bound_rows.h>
#include <snug/bounds/bound_table.h>

namespace snug {

/// Rows and tables of common kinds of every scheme, made beforehand and compiled in: shipped.bin beside this file.
///
/// Guarantee: bit by bit what make_bound_rows and make_bound_table give (scripts/check_tables makes them
///            again); and each proved by the program in checker/, derivations/checker.md.
/// Source:    tablegen/, which lists the kinds; no arguments but the name of the file; IEEE doubles with the
///            error terms of geometry/rounding.h.
///
/// The file, version 3: little-endian, every field at a multiple of its size, every part at a multiple of 8.
///
///     header   char[8] "snugbnd" and a zero     u32 version     u32 kinds
///              u64 bytes of the whole file      u64 hash of all that follows this field
///              u64 length of a text             the text: generator, arguments, arithmetic; zeros to 8
///     a kind   u64 bytes of this record, this field included
///              u8 scheme, seven zeros
///              four times: u16 before, u16 after, u8 closed, u8 sharp, u16 zero      (CornerFan)
///              u32 rows                         u32 control points
///              f64 entry_error                  f64 abs_sum
///              f64 weights[control point][row]
///              u64 tables: 1, or 0
///     a table  f64 layout[control point][2]     f64 triangle[3][2]
///              f64 lower[control point - first_bounded][3], the same of upper; first_bounded is 3 for Loop, else 0
///
/// The hash of words w1, w2, ... of 8 bytes: start with 0xcbf29ce484222325; for each word
/// h = (h xor w) * 0x100000001b3, then h = h xor (h >> 29).
class ShippedBounds {
 public:
  /// Reads headers and verifies size and hash; keeps a view of `file`, which must outlive this.
  /// Errors:    SNUG_EXPECT on a file that is not whole: the one compiled in always is.
  /// Cost:      one pass over the file, below a millisecond.
  explicit ShippedBounds(std::span<const std::byte> file);

  /// What is compiled in; read on first use.
  [[nodiscard]] static const ShippedBounds& compiled_in();
  [[nodiscard]] static std::span<const std::byte> compiled_in_file();

  /// Nothing if this kind, or this table of it, is not shipped.
  [[nodiscard]] std::optional<BoundRows> rows(const Kind& kind) const;
  [[nodiscard]] std::optional<BoundTable> table(const KindKey& key) const;
  /// In the order of the file.
  [[nodiscard]] const std::vector<KindKey>& keys() const { return keys_; }

 private:
  std::vector<KindKey> keys_;
  std::unordered_map<KindKey, std::span<const std::byte>, KindKeyHash> bodies_;  // records after their keys
};

}  // namespace snug
