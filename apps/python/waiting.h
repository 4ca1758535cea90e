#pragma once
// Long work in a thread of its own, while the thread of Python waits for it, hears signals and calls
// callables.

#include <pybind11/pybind11.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>

#include "renderer/render.h"

namespace gatelight::python {

class Waiting {
 public:
  /// `progress` is called with a dictionary, `stop` without arguments; each may be None.
  explicit Waiting(pybind11::object progress = pybind11::none(), pybind11::object stop = pybind11::none(),
                   std::atomic<bool>* stop_flag = nullptr);

  /// Runs the work without Python's lock, and waits. A signal of Python (Ctrl-C) and an exception of a
  /// callable stop the work and are thrown at its end. Throws what the work throws. Call it with Python's
  /// lock.
  void run(const std::function<void()>& work);

  /// Callbacks for a renderer in the work.
  renderer::Callbacks callbacks();
  bool stopped() const { return *stop_flag_; }

 private:
  void call();

  pybind11::object progress_;
  pybind11::object stop_;
  std::atomic<bool> own_flag_ = false;
  std::atomic<bool>* stop_flag_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<renderer::Progress> latest_;
  bool done_ = false;
};

}  // namespace gatelight::python
