#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <gmpxx.h>

#include <snug/independence/piece_step.h>
#include <snug/run.h>

namespace snug {

/// Domains of nodal functions: parts of a piece with one extraordinary corner, or of what is around the corner.
/// Rings are counted from 1; ring k + 1 is the half of ring k in size, nearer to the corner.
struct IndependenceDomain {
  enum class Kind {
    piece,    ///< polynomial piece `first` of ring 1, 1 to 3
    pieces,   ///< two of them
    ring,     ///< ring `first` alone
    rings,    ///< rings 1 to `first`
    omega,    ///< the whole piece: all rings
    annulus,  ///< ring 1 of all pieces around the corner
    global,   ///< a closed mesh with two corners of this valence, see closed_net()
  };
  Kind kind = Kind::omega;
  std::uint32_t first = 0, second = 0;
  friend bool operator==(const IndependenceDomain&, const IndependenceDomain&) = default;
};
[[nodiscard]] std::string name_of(const IndependenceDomain& domain);
/// Nothing for a text that names no domain.
[[nodiscard]] std::optional<IndependenceDomain> parse_domain(const std::string& text);

/// Entries that are not zero, by point from 0: coefficients of a polynomial in 2 cos(2 pi / n).
using PolynomialVector = std::map<std::uint32_t, std::vector<mpq_class>>;

/// Why the rank is what it is; docs/independence.md says how each is checked.
struct RankCertificate {
  enum class Bound { full, count, kernel };
  std::uint32_t prime = 0,
                root = 0;  ///< the rank modulo this prime is that of the domain; root 0 at a boundary
  std::optional<std::uint32_t> rings;  ///< omega: so many are enough for it
  std::optional<std::uint32_t> steps;  ///< global: after so many steps
  Bound bound = Bound::full;           ///< why it is no greater
  std::uint32_t left_out = 0;          ///< irrational rows left out of the kernel
  std::optional<mpq_class> factor;     ///< omega: a step maps each vector to this multiple of itself
  std::vector<PolynomialVector> kernel;
};

/// The rank of the nodal functions of K control points on a domain.
struct IndependenceCase {
  PieceCorners corners;
  IndependenceDomain domain;
  std::uint32_t dimension = 0, rank = 0;
  RankCertificate certificate;
  std::string statement;     ///< of [Wu05, ch. 3]; empty for none
  std::optional<bool> text;  ///< what that says: independent?

  [[nodiscard]] bool independent() const { return rank == dimension; }
};

/// A domain, and the dissertation's statement about it.
struct IndependenceRequest {
  IndependenceDomain domain;
  std::string statement;
  std::optional<bool> text;
};

/// This domain with what chapter 3 says of it.
[[nodiscard]] IndependenceRequest chapter_request(const ExactScheme& scheme, std::uint32_t valence,
                                                  const IndependenceDomain& domain);
/// All that chapter 3 speaks of, and all numbers of rings up to the last that adds something.
[[nodiscard]] std::vector<IndependenceDomain> chapter_domains(const ExactScheme& scheme,
                                                              std::uint32_t valence);
/// So many rings are enough, and one less is not, say conjectures 1 and 2; 0 where they say nothing: other schemes, Loop below
/// 8, Catmull-Clark below 6.
[[nodiscard]] std::uint32_t conjectured_rings(const ExactScheme& scheme, std::uint32_t valence);
/// All numbers of rings up to the last that adds something, and the whole piece.
[[nodiscard]] std::vector<IndependenceDomain> two_corner_domains(const ExactScheme& scheme,
                                                                 const PieceCorners& corners);

/// Those of a face at a boundary vertex: polynomial pieces of ring 1, all numbers of rings up to the last that adds something,
/// and the whole piece.
[[nodiscard]] std::vector<IndependenceDomain> boundary_domains(const ExactScheme& scheme,
                                                               const PieceCorners& corners);

/// Exact ranks with certificates.
///
/// Guarantee: ranks are those of the functions, in exact arithmetic.
/// Requires:  corners that boundary_step() or two_corner_step() takes; with two of them `rings` and `omega` alone, at a
///            boundary neither `annulus` nor `global`.
/// Errors:    Interrupted; InputError (refused) where no certificate is found, which is not known to happen: an unlucky prime,
///            whose ranks are too low for any kernel, is followed by the next one.
/// Cost:      grows as the cube of the valence times the rings, kernels with its fourth power; K^2 numbers are kept a ring.
/// Source:    [Wu05, ch. 3]; docs/derivations/independence.md.
[[nodiscard]] std::vector<IndependenceCase> independence_cases(
    const ExactScheme& scheme, const PieceCorners& corners, const std::vector<IndependenceRequest>& requests,
    const WorkMonitor& monitor = {}, std::uint32_t min_prime = std::uint32_t{1} << 30);

}  // namespace snug
