#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <snug/patch/neighbourhood.h>

namespace tablegen {

/// The rows of each kind down to tip_depth(), its table, and the one for tips of this kind (tip_layout()), as
/// make_bounding_rows and make_bound_table give them; and what quadratic_triangle() uses of it.
///
/// The file, version 5: little-endian, every field at a multiple of its size, every part at a multiple of 8.
///
///     header   char[8] "snugbnd" and a zero     u32 version     u32 kinds
///              u64 bytes of the whole file      u64 hash of all that follows this field
///              u64 length of a text             the text: generator, kinds, arithmetic; zeros to 8
///     a kind   u64 bytes of this record, this field included
///              u8 scheme, seven zeros
///              four times: u16 before, u16 after, u8 closed, u8 sharp, u16 zero      (CornerFan)
///              u32 rows                         u32 control points
///              f64 entry_error                  f64 abs_sum
///              f64 weights[control point][row]
///              u64 tables: 2, or fewer
///     a table  f64 layout[control point][2]     f64 triangle[3][2]
///              f64 lower[control point - first_bounded][3], the same of upper; first_bounded is 3 for Loop,
///              else 0
///     then     u64 quadratics: 1, or none
///     those    f64 fit[control point][6]
///              two comparisons, by the rows kept of the kind and by one level of them
///              u64 frames: 1, or none
///     a        u32 rows                         u32 Bezier points, the first of them
///   comparison f64 entry_error                  f64 abs_sum
///              f64 weights[control point][row]
///              f64 weights of the quadratic's six points[6][Bezier point]
///              u64 nets
///     a net    its kind's corners, as above     u64 its first row
///              f64 weights of the six points[points of the quadratic over the net's piece: 6][6]
///     a frame  f64 layout[control point][2]     f64 largest basis function[control point]
///              f64 error of offsets             u64 offsets
///              f64 offsets[offset][2]
///
/// The hash of words w1, w2, ... of 8 bytes: start with 0xcbf29ce484222325; for each word
/// h = (h xor w) * 0x100000001b3, then h = h xor (h >> 29).
[[nodiscard]] std::vector<std::byte> file_of(std::span<const snug::KindKey> keys);

}  // namespace tablegen
