#include <algorithm>
#include <charconv>

#include <apps/snug/common.h>
#include <apps/snug/progress_bar.h>
#include <fmt/core.h>
#include <snug/independence/cases.h>
#include <snug/independence/eigenvalues.h>
#include <snug/independence/piece_step.h>
#include <support/names.h>
#include <support/parallel.h>

#include "commands.h"
#include "mesh_independence.h"

namespace snug::command {
namespace {

constexpr std::uint32_t min_valence = 3, min_boundary_faces = 1, largest_valence = 200, max_rings = 256;

struct Options : CommonOptions {
  std::string valence, border, mesh;
  std::optional<std::uint64_t> second, face;
  bool opposite = false;
  std::vector<std::string> domains;
  bool older = false, matrices = false, eigenvalues = false;
};

struct Range {
  std::uint32_t first, last;
};

// "7" or "3..30".
Range parse_valences(const std::string& text, std::uint32_t least) {
  const auto refuse = [&](const char* why) {
    throw UsageError(fmt::format("--valence: '{}' {}; give a number or a range from {} to {}, such as 3..30",
                                 text, why, least, largest_valence));
  };
  const std::size_t dots = text.find("..");
  const auto number = [&](const std::string& word) {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc() || end != word.data() + word.size()) refuse("is not a valence");
    if (value < least || value > largest_valence) refuse("goes beyond what is looked at");
    return value;
  };
  const Range range{number(text.substr(0, dots)),
                    number(dots == std::string::npos ? text : text.substr(dots + 2))};
  if (range.first > range.last) refuse("ends before it begins");
  return range;
}

ExactScheme exact_scheme(const Options& options) {
  ExactScheme scheme;
  scheme.older_vertices = options.older;
  // auto is Loop: the dissertation's first.
  if (options.scheme != "auto") scheme.scheme = choose_scheme(options.scheme, {});
  if (options.scheme == "curve" || scheme.scheme == Scheme::bilinear || scheme.scheme == Scheme::flat) {
    throw UsageError("--scheme: nodal functions are those of loop, catmark, doo-sabin and midedge");
  }
  if (options.older && scheme.scheme != Scheme::catmark)
    throw UsageError("--older-rule needs --scheme catmark");
  return scheme;
}

// All pieces asked about; at a boundary vertex one face of each two that are mirror images.
std::vector<PieceCorners> pieces_of(const Options& options, Range valences) {
  std::vector<PieceCorners> pieces;
  for (std::uint32_t n = valences.first; n <= valences.last; ++n) {
    PieceCorners corners{n, {}, options.opposite};
    if (options.second) corners.second = static_cast<std::uint32_t>(*options.second);
    if (options.border.empty()) {
      pieces.push_back(corners);
      continue;
    }
    const std::uint32_t face = static_cast<std::uint32_t>(options.face.value_or(0));
    for (std::uint32_t i = face == 0 ? 1 : face; i <= (face == 0 ? (n + 1) / 2 : face); ++i) {
      corners.boundary = BoundaryFace{i, options.border == "corner"};
      pieces.push_back(corners);
    }
  }
  return pieces;
}

// The domains given by --domain.
struct Domains {
  std::vector<IndependenceDomain> named;
  bool conjecture = false;
  [[nodiscard]] bool empty() const { return named.empty() && !conjecture; }
};

Domains parse_domains(const Options& options) {
  Domains domains;
  for (const std::string& text : options.domains) {
    if (text == "conjecture") {
      if (options.second || !options.border.empty())
        throw UsageError(
            "--domain conjecture: not with --second or --border; the dissertation has none for these");
      domains.conjecture = true;
      continue;
    }
    const auto domain = parse_domain(text);
    if (!domain) {
      throw UsageError(fmt::format(
          "--domain: '{}' is not piece:I, pieces:I,J (1 to 3), ring:K, rings:K, omega, annulus, global "
          "or conjecture",
          text));
    }
    if (domain->first > max_rings) {
      throw UsageError(fmt::format("--domain: '{}': K goes from 1 to {}", text, max_rings));
    }
    if (options.second && domain->kind != IndependenceDomain::Kind::rings &&
        domain->kind != IndependenceDomain::Kind::omega) {
      throw UsageError("--domain: with --second, only rings:K and omega");
    }
    if (!options.border.empty() && domain->kind > IndependenceDomain::Kind::omega) {
      throw UsageError(fmt::format(
          "--domain: '{}': with --border, only piece:I, pieces:I,J, ring:K, rings:K and omega", text));
    }
    domains.named.push_back(*domain);
  }
  return domains;
}

// Those asked for; all that the chapter speaks of where there are none.
std::vector<IndependenceRequest> requests_for(const Domains& asked, const ExactScheme& scheme,
                                              const PieceCorners& corners) {
  std::vector<IndependenceDomain> domains = asked.named;
  if (asked.empty()) {
    domains = corners.boundary ? boundary_domains(scheme, corners)
              : corners.second ? two_corner_domains(scheme, corners)
                               : chapter_domains(scheme, corners.valence);
  }
  if (const std::uint32_t k = conjectured_rings(scheme, corners.valence); asked.conjecture && k > 0) {
    domains.push_back({IndependenceDomain::Kind::rings, k - 1});
    domains.push_back({IndependenceDomain::Kind::rings, k});
  }
  std::vector<IndependenceRequest> requests;
  for (const IndependenceDomain& domain : domains) {
    requests.push_back(corners.second || corners.boundary ? IndependenceRequest{domain, "", std::nullopt}
                                                          : chapter_request(scheme, corners.valence, domain));
  }
  return requests;
}

const char* word(bool independent) { return independent ? "independent" : "dependent"; }

void write_entries(JsonWriter& json, const std::vector<mpq_class>& polynomial) {
  if (polynomial.size() == 1) {
    json.value(polynomial[0].get_str());
    return;
  }
  json.begin_array();
  for (const mpq_class& x : polynomial) json.value(x.get_str());
  json.end_array();
}

void write_certificate(JsonWriter& json, const RankCertificate& why) {
  json.key("certificate").begin_object().field("prime", why.prime);
  if (why.root != 0) json.field("root", why.root);
  if (why.rings) json.field("rings", *why.rings);
  if (why.steps) json.field("steps", *why.steps);
  constexpr auto bounds =
      std::to_array<Named<RankCertificate::Bound>>({{"full", RankCertificate::Bound::full},
                                                    {"count", RankCertificate::Bound::count},
                                                    {"kernel", RankCertificate::Bound::kernel}});
  json.field("bound", name_in(bounds, why.bound));
  if (why.bound == RankCertificate::Bound::kernel) {
    json.field("left_out", why.left_out);
    if (why.factor) json.field("factor", why.factor->get_str());
    json.key("kernel").begin_array();
    for (const PolynomialVector& v : why.kernel) {
      json.begin_object();
      for (const auto& [point, entry] : v) {
        json.key(std::to_string(point + 1));
        write_entries(json, entry);
      }
      json.end_object();
    }
    json.end_array();
  }
  json.end_object();
}

void write_boundary(JsonWriter& json, const PieceCorners& corners) {
  if (!corners.boundary) return;
  json.field("border", corners.boundary->face);
  if (corners.boundary->corner) json.field("corner", true);
}

void write_case(JsonWriter& json, const IndependenceCase& found, bool older) {
  json.begin_object().field("valence", found.corners.valence);
  if (found.corners.second) {
    json.field("second", *found.corners.second).field("place", found.corners.opposite ? "opposite" : "edge");
  }
  write_boundary(json, found.corners);
  json.field("domain", name_of(found.domain));
  json.field("dimension", found.dimension)
      .field("rank", found.rank)
      .field("independent", found.independent());
  json.key("statement");
  if (found.statement.empty()) {
    json.null();
  } else {
    json.value(found.statement);
  }
  json.key("text");
  if (found.text) {
    json.value(word(*found.text));
  } else {
    json.null();
  }
  if (older) json.field("rule", "older");
  write_certificate(json, found.certificate);
  json.end_object();
}

std::string text_of(const IndependenceCase& found) {
  std::string beside;
  if (found.corners.second) beside = fmt::format(" {:>4}", *found.corners.second);
  if (found.corners.boundary) beside = fmt::format(" {:>4}", found.corners.boundary->face);
  std::string line =
      fmt::format("{:>4}{}  {:<11} {:>4} of {:<4} {:<11}", found.corners.valence, beside,
                  name_of(found.domain), found.rank, found.dimension, word(found.independent()));
  if (!found.text) return line;
  line += "  " + found.statement;
  if (*found.text != found.independent()) line += fmt::format(", which says {}", word(*found.text));
  return line;
}

// Entries that are not zero, as {"column": "3/8"}, or {"rational": ..., "cosines": {"i": factor of 2cos(2 pi i/n)}}.
void write_row(JsonWriter& json, const WeightRow& row) {
  json.begin_object();
  for (const auto& [point, w] : row) {
    json.key(std::to_string(point + 1));
    if (w.is_rational()) {
      json.value(w.rational.get_str());
      continue;
    }
    json.begin_object().field("rational", w.rational.get_str()).key("cosines").begin_object();
    for (const auto& [index, factor] : w.cosines) json.field(std::to_string(index), factor.get_str());
    json.end_object().end_object();
  }
  json.end_object();
}

void write_matrices(JsonWriter& json, const ExactScheme& scheme, const PieceCorners& corners) {
  const PieceStep step = corners.boundary ? boundary_step(scheme, corners.valence, *corners.boundary)
                                          : piece_step(scheme, corners.valence);
  json.begin_object().field("valence", corners.valence);
  write_boundary(json, corners);
  json.field("rows", step.rows.size()).field("columns", step.dimension);
  json.field("kept", step.kept).key("matrix").begin_array();
  for (const WeightRow& row : step.rows) write_row(json, row);
  json.end_array().key("pieces").begin_array();
  for (const auto& piece : step.pieces) {
    json.begin_array();
    for (const Functional& functional : piece) {
      json.begin_array();
      for (const auto& [row, sign] : functional) json.value(sign * static_cast<int>(row + 1));
      json.end_array();
    }
    json.end_array();
  }
  json.end_array().end_object();
}

void write_eigenvalues(JsonWriter& json, const CornerEigenvalues& found, std::uint32_t valence) {
  json.begin_object()
      .field("valence", valence)
      .field("as_stated", found.as_stated)
      .key("repeated")
      .begin_array();
  for (const RationalEigenvalue& each : found.repeated) {
    json.begin_object().field("value", each.value.get_str()).field("algebraic", each.algebraic);
    json.field("geometric", each.geometric()).key("span").begin_array();
    for (const std::vector<mpq_class>& vector : each.span) {
      json.begin_object();
      for (std::size_t i = 0; i < vector.size(); ++i) {
        if (vector[i] != 0) json.field(std::to_string(i + 1), vector[i].get_str());
      }
      json.end_object();
    }
    json.end_array().end_object();
  }
  json.end_array().end_object();
}

std::string text_of(const CornerEigenvalues& found, std::uint32_t valence) {
  std::string line =
      fmt::format("{:>4}  eigenvalues {}", valence, found.as_stated ? "as stated" : "not as stated");
  for (const RationalEigenvalue& each : found.repeated) {
    line += fmt::format(", {} {} times", each.value.get_str(), each.algebraic);
    if (each.geometric() < each.algebraic) line += fmt::format(" with {} eigenvectors", each.geometric());
  }
  return line;
}

ExitStatus run_on_valences(const Options& options) {
  const Range range =
      parse_valences(options.valence, options.border.empty() ? min_valence : min_boundary_faces);
  const ExactScheme scheme = exact_scheme(options);
  if (!options.border.empty() && scheme.dual()) {
    throw UsageError(
        fmt::format("--border: with {} the surface ends inside the control mesh, so no piece of it is at the "
                    "boundary: each has all faces "
                    "around its vertex, and is one that --valence gives without --border",
                    name_of(scheme.scheme)));
  }
  if (options.face && *options.face > range.first) {
    throw UsageError(
        fmt::format("--face: a boundary vertex with {} faces has no face {}; let --valence begin at {}",
                    range.first, *options.face, *options.face));
  }
  if (options.eigenvalues && (scheme.dual() || scheme.older_vertices)) {
    throw UsageError("--eigenvalues: the dissertation lists those of loop and catmark");
  }
  if (options.second && scheme.scheme == Scheme::loop &&
      (options.opposite || range.first + *options.second < 7)) {
    throw UsageError(options.opposite
                         ? "--opposite: a triangle has no opposite corners"
                         : "--second: two corners of valence 3 at an edge are a mesh of four triangles");
  }
  if (options.matrices && !options.json) throw UsageError("--matrices needs --json");
  const Domains domains = parse_domains(options);
  if (domains.conjecture && domains.named.empty() && conjectured_rings(scheme, range.last) == 0) {
    throw UsageError(
        "--domain conjecture: the dissertation has one for loop with valence 8 and more, and one for catmark "
        "with 6 "
        "and more");
  }
  const std::vector<PieceCorners> pieces = pieces_of(options, range);
  const std::size_t count = pieces.size();
  std::vector<std::vector<IndependenceCase>> found(count);
  std::vector<CornerEigenvalues> eigenvalues(options.eigenvalues ? count : 0);
  Report report("independence", options);
  {
    ProgressBar bar("ranks", options.quiet);
    const WorkMonitor monitor = bar.monitor();
    std::atomic<std::size_t> done = 0;
    // The largest first: it takes longest.
    parallel_for(count, options.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const PieceCorners& corners = pieces[count - 1 - i];
        found[count - 1 - i] =
            independence_cases(scheme, corners, requests_for(domains, scheme, corners), monitor);
        if (options.eigenvalues) eigenvalues[count - 1 - i] = corner_eigenvalues(scheme, corners.valence);
        monitor.report(static_cast<double>(++done) / static_cast<double>(count));
      }
    });
  }
  if (report.json()) {
    JsonWriter& json = report.write();
    json.field("scheme", name_of(scheme.scheme)).key("cases").begin_array();
    for (const auto& cases : found) {
      for (const IndependenceCase& each : cases) write_case(json, each, scheme.older_vertices);
    }
    json.end_array();
    if (options.eigenvalues) {
      json.key("eigenvalues").begin_array();
      for (std::uint32_t n = range.first; n <= range.last; ++n)
        write_eigenvalues(json, eigenvalues[n - range.first], n);
      json.end_array();
    }
    if (options.matrices) {
      json.key("matrices").begin_array();
      for (const PieceCorners& corners : pieces) write_matrices(json, scheme, corners);
      json.end_array();
    }
  }
  for (const auto& cases : found) {
    for (const IndependenceCase& each : cases) report.text(text_of(each));
  }
  for (std::uint32_t n = range.first; options.eigenvalues && n <= range.last; ++n) {
    report.text(text_of(eigenvalues[n - range.first], n));
  }
  return report.finish();
}

ExitStatus run(const Options& options) {
  if (options.mesh.empty() == options.valence.empty()) {
    throw UsageError(
        "independence: give --valence A..B for pieces with one extraordinary corner, or --mesh FILE");
  }
  if (!options.mesh.empty()) return independence_of_mesh(options.mesh, options);
  if (!options.weld.empty() || !options.sharp.empty() || !options.boundary.empty()) {
    throw UsageError("--weld, --sharp and --boundary need --mesh");
  }
  return run_on_valences(options);
}

}  // namespace

Command independence_command() {
  auto options = std::make_shared<Options>();
  OptionList list;
  list.add(Group::own, "--valence RANGE", &options->valence,
           "Pieces with one extraordinary corner of these valences (dual schemes: corners of a face), such "
           "as 3..30; --scheme auto is loop then");
  list.add(Group::own, "--domain DOMAIN", &options->domains,
           "Where functions are looked at: piece:I, pieces:I,J, ring:K, rings:K, omega, annulus, global, "
           "conjecture; several "
           "times for several. Without: all that chapter 3 speaks of, and all numbers of rings")
      .needs("--valence");
  list.add(Group::own, "--second N", &options->second,
           "A second extraordinary corner of this valence, at the other end of an edge of the piece")
      .needs("--valence")
      .between(min_valence, largest_valence);
  list.add(Group::own, "--opposite", &options->opposite,
           "The second corner across the quad (dual schemes: the vertex)")
      .needs("--second");
  list.add(Group::own, "--border KIND", &options->border,
           "Loop and Catmull-Clark: faces at a boundary vertex instead, which has as many faces as --valence "
           "says, 1 and "
           "more, and is smooth or a sharp corner; of two faces that are mirror images the first")
      .needs("--valence")
      .one_of({"smooth", "corner"})
      .excludes("--second")
      .excludes("--older-rule")
      .excludes("--eigenvalues");
  list.add(Group::own, "--face I", &options->face, "One of them, counted from a boundary edge to the other")
      .needs("--border")
      .between(min_boundary_faces, largest_valence);
  list.add(Group::own, "--older-rule", &options->older,
           "Catmull-Clark with the vertex points (Q + R + 2S)/4 of an early version")
      .needs("--valence");
  list.add(Group::own, "--eigenvalues", &options->eigenvalues,
           "Loop and Catmull-Clark: with the eigenvalues of a step, against those of the dissertation")
      .needs("--valence");
  list.add(Group::own, "--matrices", &options->matrices,
           "With the exact matrices of a step, and what pieces pick of them")
      .needs("--valence");
  list.add(Group::own, "--mesh FILE", &options->mesh,
           "A whole mesh: which control values leave its surface as it is")
      .excludes("--valence");
  add_common_options(list, *options);
  return {"independence",
          Topic::functions,
          "Which nodal functions are linearly independent, and where, by exact arithmetic",
          {"snug-research independence --scheme loop --valence 3..30 --json -o loop.json",
           "snug-research independence --scheme catmark --valence 100 --domain conjecture",
           "snug-research independence --mesh cube.obj"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
