#include "apps/mpi/heartbeats.h"

#include <algorithm>

namespace gatelight::apps {
namespace {

constexpr double kBeatSeconds = 1.0;
constexpr double kPatienceWithFirst = 5.0;  // seconds

/// Limit of the silence that one step adds. A longer step means that this process itself was stopped and did
/// not receive.
constexpr double kLongestStep = 0.5;  // seconds

}  // namespace

Heartbeats::Heartbeats(const MpiWorld& world, Mailbox& mailbox, double silence)
    : mailbox_(mailbox), silence_(silence), last_step_(Clock::now()) {
  if (world.rank == 0) {
    for (int rank = 1; rank < world.count; ++rank) peers_.push_back({.rank = rank});
  } else {
    peers_.push_back({.rank = 0});
    // Ranks give up one after the other, so that only one of them prints a line.
    silence_ += kPatienceWithFirst + std::min(world.rank - 1, 10);
  }
}

void Heartbeats::receive(const Mailbox::Message& beat) {
  for (Peer& peer : peers_) {
    if (peer.rank != beat.rank) continue;
    peer.silent = 0.0;
    peer.left = beat.bytes != renderer::Bytes(sizeof(int));
  }
}

std::optional<Heartbeats::Lost> Heartbeats::step() {
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - last_step_).count();
  last_step_ = now;
  if (leaving_) return std::nullopt;
  until_beat_ -= seconds;
  const bool due = until_beat_ <= 0.0;
  if (due) {
    until_beat_ = kBeatSeconds;
    mailbox_.forget_sent();
  }
  for (Peer& peer : peers_) {
    if (due && !mailbox_.sending(peer.rank, kTag)) send(peer.rank, false);
    if (peer.left) continue;
    peer.silent += std::min(seconds, kLongestStep);
    if (peer.silent > silence_) return Lost{.rank = peer.rank, .seconds = peer.silent};
  }
  return std::nullopt;
}

void Heartbeats::announce_exit() {
  if (!leaving_) {
    for (const Peer& peer : peers_) send(peer.rank, true);
  }
  leaving_ = true;
}

bool Heartbeats::all_said_goodbye() const {
  return std::all_of(peers_.begin(), peers_.end(), [](const Peer& peer) { return peer.left; });
}

void Heartbeats::send(int to, bool last) {
  renderer::Bytes beat(sizeof(int));
  beat[0] = std::byte{last};
  mailbox_.send(to, kTag, std::move(beat));
}

}  // namespace gatelight::apps
