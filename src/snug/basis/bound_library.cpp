#include <snug/basis/bound_library.h>

namespace snug {

const BoundRows& BoundLibrary::rows(const Kind& kind) {
  return rows_.get(kind.id(), [&] { return make_bound_rows(kind); });
}

const BoundTable& BoundLibrary::table(const Kind& kind, TableLayout layout) {
  return tables_[static_cast<std::size_t>(layout)].get(
      kind.id(), [&] { return make_bound_table(kind, rows(kind), layout); });
}

}  // namespace snug
