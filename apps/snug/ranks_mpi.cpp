#include <mpi.h>

#include <algorithm>

#include "ranks_interface.h"

namespace {

constexpr std::size_t most_at_once = std::size_t{1} << 30;  // counts are int
constexpr int tag = 1;

int join(int* rank, int* size, int* size_of_node) {
  int provided = 0;
  const int failure = MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  if (failure != MPI_SUCCESS) return failure;
  MPI_Comm_rank(MPI_COMM_WORLD, rank);
  MPI_Comm_size(MPI_COMM_WORLD, size);
  MPI_Comm node;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node);
  MPI_Comm_size(node, size_of_node);
  MPI_Comm_free(&node);
  return provided >= MPI_THREAD_FUNNELED ? 0 : -1;
}

void broadcast(char* bytes, std::size_t count) {
  for (std::size_t begin = 0; begin < count; begin += most_at_once) {
    const int part = static_cast<int>(std::min(most_at_once, count - begin));
    MPI_Bcast(bytes + begin, part, MPI_BYTE, 0, MPI_COMM_WORLD);
  }
}

void send(int to, const char* bytes, std::size_t count) {
  MPI_Send(bytes, static_cast<int>(count), MPI_BYTE, to, tag, MPI_COMM_WORLD);
}

long probe(bool wait, int* from) {
  MPI_Status status;
  int there = 1;
  if (wait) {
    MPI_Probe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &status);
  } else {
    MPI_Iprobe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &there, &status);
  }
  if (there == 0) return -1;
  int count = 0;
  MPI_Get_count(&status, MPI_BYTE, &count);
  *from = status.MPI_SOURCE;
  return count;
}

void receive(int from, char* bytes, std::size_t count) {
  MPI_Recv(bytes, static_cast<int>(count), MPI_BYTE, from, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
}

void leave() { MPI_Finalize(); }

}  // namespace

extern "C" const SnugRanks* snug_ranks() {
  static const SnugRanks functions{join, broadcast, send, probe, receive, leave};
  return &functions;
}
