#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>

#include "ranks_interface.h"
#include "ranks_pulse.h"

namespace {

constexpr std::size_t max_at_once = std::size_t{1} << 30;  // counts are int
constexpr int tag = 1;

// None without a limit, and where MPI allows one thread alone.
std::unique_ptr<Pulse> pulse;

int silent() { return pulse ? pulse->silent() : -1; }

// False if a rank is silent. Looks leave the processor to others.
template <class Done>
bool wait_until(const Done& done) {
  constexpr std::chrono::microseconds longest{1000};
  std::chrono::microseconds pause{50};
  for (int looks = 0; !done(); ++looks) {
    if (silent() >= 0) return false;
    if (looks < 100) {
      std::this_thread::yield();
      continue;
    }
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, longest);
  }
  return true;
}

bool wait_for(MPI_Request request) {
  return wait_until([&] {
    int done = 0;
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    return done != 0;
  });
}

int join(double patience, int* rank, int* size, int* size_of_node) {
  int provided = 0;
  const int failure = MPI_Init_thread(nullptr, nullptr, MPI_THREAD_MULTIPLE, &provided);
  if (failure != MPI_SUCCESS) return failure;
  MPI_Comm_rank(MPI_COMM_WORLD, rank);
  MPI_Comm_size(MPI_COMM_WORLD, size);
  MPI_Comm node;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node);
  MPI_Comm_size(node, size_of_node);
  MPI_Comm_free(&node);
  if (patience > 0 && provided == MPI_THREAD_MULTIPLE) pulse = std::make_unique<Pulse>(patience);
  return provided >= MPI_THREAD_FUNNELED ? 0 : -1;
}

bool broadcast(char* bytes, std::size_t count) {
  for (std::size_t begin = 0; begin < count; begin += max_at_once) {
    const int part = static_cast<int>(std::min(max_at_once, count - begin));
    MPI_Request request;
    MPI_Ibcast(bytes + begin, part, MPI_BYTE, 0, MPI_COMM_WORLD, &request);
    if (!wait_for(request)) return false;
  }
  return true;
}

bool send(int to, const char* bytes, std::size_t count) {
  MPI_Request request;
  MPI_Isend(bytes, static_cast<int>(count), MPI_BYTE, to, tag, MPI_COMM_WORLD, &request);
  return wait_for(request);
}

long probe(bool wait, int* from) {
  MPI_Status status;
  const auto look = [&] {
    int there = 0;
    MPI_Iprobe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &there, &status);
    return there != 0;
  };
  if (!(wait ? wait_until(look) : look())) return -1;
  int count = 0;
  MPI_Get_count(&status, MPI_BYTE, &count);
  *from = status.MPI_SOURCE;
  return count;
}

bool receive(int from, char* bytes, std::size_t count) {
  MPI_Request request;
  MPI_Irecv(bytes, static_cast<int>(count), MPI_BYTE, from, tag, MPI_COMM_WORLD, &request);
  return wait_for(request);
}

bool leave() {
  if (pulse && !pulse->leave()) return false;
  MPI_Finalize();
  return true;
}

}  // namespace

extern "C" const SnugRanks* snug_ranks() {
  static const SnugRanks functions{join, broadcast, send, probe, receive, leave, silent};
  return &functions;
}
