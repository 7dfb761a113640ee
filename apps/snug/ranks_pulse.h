#pragma once

#include <mpi.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

/// Signs of life between rank 0 and each other rank, sent by a thread of their own, so that a rank at work is not silent
/// and a stopped process is.
///
/// Requires:  MPI_THREAD_MULTIPLE.
class Pulse {
 public:
  /// A collective call.
  explicit Pulse(double patience) : patience_(patience), pause_(std::min(patience / 4, 1.0)) {
    int rank = 0, size = 0;
    MPI_Comm_dup(MPI_COMM_WORLD, &line_);
    MPI_Comm_rank(line_, &rank);
    MPI_Comm_size(line_, &size);
    for (int other = rank == 0 ? 1 : 0; other < (rank == 0 ? size : 1); ++other) peers_.push_back({other});
    thread_ = std::thread([this] { beat(); });
  }
  Pulse(const Pulse&) = delete;
  Pulse& operator=(const Pulse&) = delete;
  /// Of a process that ends while others may not: nobody is waited for.
  ~Pulse() { end(State::stopping); }

  [[nodiscard]] int silent() const { return silent_; }
  /// Waits until all have called it; false if one is silent.
  bool leave() {
    end(State::leaving);
    if (silent_ < 0) MPI_Comm_free(&line_);
    return silent_ < 0;
  }

 private:
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;
  enum class State { running, leaving, stopping };
  static constexpr char alive = 'A', last = 'L';

  struct Peer {
    int rank;
    Clock::time_point heard = Clock::now();
    MPI_Request sending = MPI_REQUEST_NULL;
    bool said_last = false, heard_last = false;
  };

  void end(State state) {
    if (!thread_.joinable()) return;
    {
      const std::lock_guard lock(mutex_);
      state_ = state;
    }
    wake_.notify_all();
    thread_.join();
  }

  void hear() {
    for (int there = 1; there != 0;) {
      MPI_Status status;
      MPI_Iprobe(MPI_ANY_SOURCE, 0, line_, &there, &status);
      if (there == 0) return;
      char byte = 0;
      MPI_Recv(&byte, 1, MPI_CHAR, status.MPI_SOURCE, 0, line_, MPI_STATUS_IGNORE);
      for (Peer& peer : peers_) {
        if (peer.rank != status.MPI_SOURCE) continue;
        peer.heard = Clock::now();
        peer.heard_last = byte == last;
      }
    }
  }

  // True once a last sign went both ways.
  bool speak(Peer& peer, bool leaving) {
    int sent = 1;
    MPI_Test(&peer.sending, &sent, MPI_STATUS_IGNORE);
    if (sent == 0) return false;
    if (peer.said_last) return peer.heard_last;
    peer.said_last = leaving;
    MPI_Isend(leaving ? &last : &alive, 1, MPI_CHAR, peer.rank, 0, line_, &peer.sending);
    return false;
  }

  void beat() {
    Clock::time_point before = Clock::now();
    for (std::unique_lock lock(mutex_); state_ != State::stopping;) {
      const State state = state_;
      lock.unlock();
      const Clock::time_point now = Clock::now();
      // This process was stopped itself, perhaps with the whole job: the others have had no chance.
      const bool slept = Seconds(now - before).count() > pause_ + patience_ / 2;
      before = now;
      if (slept) {
        for (Peer& peer : peers_) peer.heard = now;
      }
      hear();
      std::size_t done = 0;
      for (Peer& peer : peers_) {
        done += speak(peer, state == State::leaving) ? 1 : 0;
        if (!peer.heard_last && Seconds(now - peer.heard).count() > patience_) silent_ = peer.rank;
      }
      lock.lock();
      if (silent_ >= 0 || done == peers_.size()) return;
      const Seconds pause(state == State::leaving ? pause_ / 256 : pause_);
      wake_.wait_for(lock, pause, [&] { return state_ != state; });
    }
  }

  MPI_Comm line_ = MPI_COMM_NULL;
  double patience_, pause_;
  std::vector<Peer> peers_;
  std::atomic<int> silent_{-1};
  std::mutex mutex_;
  std::condition_variable wake_;
  State state_ = State::running;
  std::thread thread_;
};
