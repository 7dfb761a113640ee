#pragma once

#include <cstddef>

/// What snug_mpi.so, the only part that is linked with MPI, does for the command, which loads it under mpirun alone.
extern "C" {
struct SnugRanks {
  /// Joins the job. 0, or what MPI calls the failure.
  int (*join)(int* rank, int* size, int* size_of_node);
  void (*broadcast)(char* bytes, std::size_t count);  ///< from rank 0
  void (*send)(int to, const char* bytes, std::size_t count);
  /// The size of the next message, from whoever it is; waits for one, or -1 where none is there.
  long (*probe)(bool wait, int* from);
  void (*receive)(int from, char* bytes, std::size_t count);
  void (*leave)();  ///< after the last message of all
};

/// The one function of the library.
using SnugRanksFunction = const SnugRanks* (*)();
__attribute__((visibility("default"))) const SnugRanks* snug_ranks();
}
