#include "apps/terminal/signals.h"

#include <atomic>
#include <csignal>

namespace gatelight::apps {
namespace {

std::atomic<int> stop_requested{0};
std::atomic<bool> snapshot_requested{false};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

void on_stop(int signal) {
  int none = 0;
  stop_requested.compare_exchange_strong(none, signal);
}

void on_snapshot(int) {
  snapshot_requested.store(true);
}

void install(int signal, void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags | SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

}  // namespace

void install_signal_handlers() {
  install(SIGINT, on_stop, static_cast<int>(SA_RESETHAND));
  install(SIGTERM, on_stop, static_cast<int>(SA_RESETHAND));
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) install(SIGHUP, on_stop, static_cast<int>(SA_RESETHAND));
  install(SIGUSR1, on_snapshot, 0);
}

void ignore_write_signals() {
  install(SIGPIPE, SIG_IGN, 0);
  install(SIGXFSZ, SIG_IGN, 0);
}

void request_stop(int signal) {
  on_stop(signal);
}

int stop_signal() {
  return stop_requested.load();
}

bool take_snapshot_request() {
  return snapshot_requested.exchange(false);
}

}  // namespace gatelight::apps
