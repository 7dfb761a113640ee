#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include <picture/camera.h>
#include <picture/image.h>
#include <picture/palette.h>
#include <picture/scene.h>

namespace snug {

struct Background {
  Colour top = palette::paper_top,
         foot = palette::paper_foot;  ///< blended from the upper border to the lower one
};

struct RenderOptions {
  int width = 1000, height = 1000;
  int samples = 3;  ///< a pixel is the mean of samples * samples rays; 1 to 16
  Background background;
  bool shadows = true;           ///< cast by opaque surfaces on surfaces
  double surface_tolerance = 0;  ///< of the scene's surfaces, in its units
  /// Calls body(begin, end) on ranges that cover [0, count) once, at the same time if it likes; returns when
  /// all are done. Empty: one thread.
  std::function<void(std::size_t count, const std::function<void(std::size_t, std::size_t)>& body)>
      parallel_for;
  /// Called with the share that is done, increasing to 1, once a row, never twice at the same time. It may
  /// throw.
  std::function<void(double fraction)> progress;
};

/// The picture of `scene` as `camera` sees it, anti-aliased, surfaces lit by studio lights that move with the
/// camera.
///
/// Guarantee: what is nearer hides or tints what is farther, ray by ray, in whatever order the scene lists
/// it; the bytes
///            depend on neither that order nor the threads. A ray meets exactly one of two triangles that
///            share an edge and do not fold there: closed meshes show no pinholes, transparent ones no seams.
///            A line is drawn as if nearer by three half widths, so that a surface it lies in does not hide
///            it.
/// Requires:  finite numbers, coordinates of about unit size; colours, opacity and gloss in [0, 1]; materials
/// that exist;
///            line widths > 0; a camera as camera.h asks for; width, height >= 1.
/// Errors:    InputError (value) on what is required. What `progress` throws stops the rows still to come and
///            is thrown again
///            here, on the calling thread, whatever `parallel_for` does with exceptions.
/// Cost:      about 2 s of one core for 1000 x 1000 pixels, 3 x 3 rays each, of a surface of 100 000
/// triangles that fills
///            the picture.
/// Source:    edge functions in sheared coordinates [Woop13]; differs: a ray through an edge itself goes to
/// one side
///            by the rule of rasterisers, and a pixel's rays search the hierarchy together, as a beam.
[[nodiscard]] Image render(const PictureScene& scene, const Camera& camera,
                           const RenderOptions& options = {});

/// A picture, and the rays that made it.
struct CountedImage {
  Image image;
  std::uint64_t rays = 0;
  std::uint64_t hits = 0;  ///< rays that meet a triangle or a line; all the others see the background alone
};

/// The same picture as render() makes, with counts. Guarantee, requires, errors and cost: as render().
[[nodiscard]] CountedImage render_counted(const PictureScene& scene, const Camera& camera,
                                          const RenderOptions& options = {});

}  // namespace snug
