#include "ranks.h"

#include <cstdlib>

#include <fmt/core.h>
#include <snug/run.h>

#include "process.h"

namespace snug::command {
namespace {

[[noreturn]] void fail(const std::string& reason) {
  throw InputError(InputProblem::unreadable,
                   "started by mpirun, but " + reason +
                       "; install libopenmpi-dev and build snug again, or start it without mpirun");
}

// Beside the program, or where it is installed.
const SnugRanks* functions() {
  void* library = nullptr;
  for (const char* folder : {".", SNUG_MPI_FOLDER}) {
    if (library == nullptr) library = process::load_library(process::folder() / folder / "snug_mpi.so");
  }
  if (library == nullptr) fail("snug_mpi.so is not there or cannot be loaded");
  void* const symbol = process::symbol_of(library, "snug_ranks");
  if (symbol == nullptr) fail("snug_mpi.so is of another version");
  return reinterpret_cast<SnugRanksFunction>(symbol)();
}

}  // namespace

std::unique_ptr<Ranks> Ranks::join(double patience) {
  const char* const size = std::getenv("OMPI_COMM_WORLD_SIZE");
  if (size == nullptr || std::atoi(size) < 2) return nullptr;
  std::unique_ptr<Ranks> ranks(new Ranks(functions(), patience));
  if (ranks->functions_->join(patience, &ranks->rank_, &ranks->size_, &ranks->size_of_node_) != 0) {
    fail("MPI cannot be started");
  }
  return ranks;
}

void Ranks::require(bool done) const {
  if (done) return;
  throw InputError(
      InputProblem::unreadable,
      fmt::format("rank {} has been silent for {} s: it is stopped, or its machine cannot be reached; "
                  "run again, or wait longer with --rank-timeout",
                  functions_->silent(), patience_));
}

std::string Ranks::broadcast(std::string bytes) const {
  std::size_t size = bytes.size();
  require(functions_->broadcast(reinterpret_cast<char*>(&size), sizeof size));
  bytes.resize(size);
  require(functions_->broadcast(bytes.data(), size));
  return bytes;
}

void Ranks::send(int to, std::string_view bytes) const {
  require(functions_->send(to, bytes.data(), bytes.size()));
}

std::optional<Ranks::Message> Ranks::receive(bool wait) const {
  Message message{0, {}};
  const long size = functions_->probe(wait, &message.from);
  if (size < 0) {
    require(functions_->silent() < 0);
    return {};
  }
  message.bytes.resize(static_cast<std::size_t>(size));
  require(functions_->receive(message.from, message.bytes.data(), message.bytes.size()));
  return message;
}

void Ranks::leave() const { require(functions_->leave()); }

}  // namespace snug::command
