#pragma once

#include <cstddef>

/// Functions of snug_mpi.so, the only part linked with MPI; the command loads it under mpirun alone.
/// Nothing here blocks for ever: each wait ends once a rank has been silent for too long.
extern "C" {
struct SnugRanks {
  /// Joins the job. `patience`: seconds of silence after which a rank counts as lost; 0 for no limit. 0, or what MPI
  /// calls the failure.
  int (*join)(double patience, int* rank, int* size, int* size_of_node);
  /// False, here and below: a rank is silent.
  bool (*broadcast)(char* bytes, std::size_t count);  ///< from rank 0
  bool (*send)(int to, const char* bytes, std::size_t count);
  /// The size of the next message, from whoever it is. -1 if none is there, or with `wait` if a rank is silent.
  long (*probe)(bool wait, int* from);
  bool (*receive)(int from, char* bytes, std::size_t count);
  bool (*leave)();  ///< after the last message of all
  int (*silent)();  ///< the rank that has been silent for too long, or -1
};

/// The one function of the library.
using SnugRanksFunction = const SnugRanks* (*)();
__attribute__((visibility("default"))) const SnugRanks* snug_ranks();
}
