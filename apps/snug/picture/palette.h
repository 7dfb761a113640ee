#pragma once

#include <picture/scene.h>

/// The colours of snug's pictures: one meaning each, distinct in lightness too.
namespace snug::palette {

inline constexpr Colour ink = Colour::hex(0x27303c);         ///< cage edges
inline constexpr Colour paper_top = Colour::hex(0xffffff);   ///< background, upper border
inline constexpr Colour paper_foot = Colour::hex(0xe6eaef);  ///< background, lower border
inline constexpr Colour chalk = Colour::hex(0xd5dae3);       ///< the same as ink, in dark pictures
inline constexpr Colour slate_top = Colour::hex(0x343746);   ///< their background
inline constexpr Colour slate_foot = Colour::hex(0x1d1f29);
inline constexpr Colour sea = Colour::hex(0x6aa3d0);         ///< the surface, the first of two
inline constexpr Colour amber = Colour::hex(0xf4c26a);       ///< its enclosures
inline constexpr Colour amber_edge = Colour::hex(0x94590a);  ///< their outlines
inline constexpr Colour clay = Colour::hex(0xe08c66);        ///< the second of two
inline constexpr Colour mint = Colour::hex(0x7dcdb0);        ///< its enclosures
inline constexpr Colour mint_edge = Colour::hex(0x1f6f54);   ///< their outlines
inline constexpr Colour signal = Colour::hex(0xc22f3d);      ///< contacts, witnesses, crossings

/// A limit surface: matte, with a soft highlight.
[[nodiscard]] constexpr Material surface(Colour colour = sea) { return {.colour = colour, .gloss = 0.35}; }
/// An enclosure around it: lets most of the surface through.
[[nodiscard]] constexpr Material enclosure(Colour colour = mint) {
  return {.colour = colour, .opacity = 0.33, .gloss = 0.1};
}
/// One colour without light or shade: markers.
[[nodiscard]] constexpr Material flat(Colour colour = signal) { return {.colour = colour, .lit = false}; }

/// Strokes, in pixels of a picture about a thousand pixels wide.
inline constexpr double cage_width = 2.2, outline_width = 1.2, witness_width = 5, witness_dot = 18,
                        label_height = 22, smallest_label = 9;

}  // namespace snug::palette
