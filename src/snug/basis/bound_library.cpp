#include <snug/basis/bound_library.h>

#include <optional>
#include <utility>

#include <snug/basis/shipped.h>

namespace snug {

const BoundRows& BoundLibrary::rows(const Kind& kind) {
  return rows_.get(kind.id(), [&] {
    std::optional<BoundRows> shipped = ShippedBounds::compiled_in().rows(kind);
    return shipped ? *std::move(shipped) : make_bound_rows(kind);
  });
}

const BoundTable& BoundLibrary::table(const Kind& kind, TableLayout layout) {
  return tables_[static_cast<std::size_t>(layout)].get(kind.id(), [&] {
    std::optional<BoundTable> shipped = ShippedBounds::compiled_in().table(kind.key(), layout);
    return shipped ? *std::move(shipped) : make_bound_table(kind, rows(kind), layout);
  });
}

}  // namespace snug
