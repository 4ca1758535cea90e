#include "apps/python/waiting.h"

#include <chrono>
#include <exception>
#include <thread>
#include <utility>

#include "apps/terminal/progress.h"
#include "base/platform/flush_denormals.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;

/// How long a signal may wait.
constexpr std::chrono::milliseconds kBetween{50};

py::dict dictionary_of(const renderer::Progress& progress) {
  py::dict values;
  values["phase"] = apps::word_of(progress.phase);
  values["fraction"] = progress.fraction;
  values["seconds"] = progress.seconds;
  values["spp_done"] = progress.spp_done;
  values["spp"] = progress.spp;
  values["samples"] = progress.samples;
  values["steps_done"] = progress.steps_done;
  values["steps"] = progress.steps;
  values["loss"] = progress.loss;
  values["error"] = progress.error ? py::object(py::float_(*progress.error)) : py::none();
  return values;
}

}  // namespace

Waiting::Waiting(py::object progress, py::object stop, std::atomic<bool>* stop_flag)
    : progress_(std::move(progress)),
      stop_(std::move(stop)),
      stop_flag_(stop_flag ? stop_flag : &own_flag_) {}

renderer::Callbacks Waiting::callbacks() {
  return {.progress =
              [this](const renderer::Progress& progress) {
                {
                  const std::lock_guard lock(mutex_);
                  latest_ = progress;
                }
                changed_.notify_one();
              },
          .stop = [this] { return stopped(); }};
}

void Waiting::call() {
  std::optional<renderer::Progress> progress;
  {
    const std::lock_guard lock(mutex_);
    progress = std::exchange(latest_, std::nullopt);
  }
  // Only the main thread of Python hears signals; elsewhere this does nothing.
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (progress && !progress_.is_none()) progress_(dictionary_of(*progress));
  if (!stop_.is_none() && py::bool_(stop_())) *stop_flag_ = true;
}

void Waiting::run(const std::function<void()>& work) {
  std::exception_ptr failure;
  std::exception_ptr of_python;
  std::thread thread([&] {
    const FlushDenormals flush;
    try {
      work();
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    done_ = true;
    changed_.notify_one();
  });
  bool done = false;
  while (!done) {
    {
      const py::gil_scoped_release release;
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, kBetween, [&] { return done_ || (latest_ && !of_python); });
      done = done_;
    }
    if (of_python) continue;
    try {
      call();
    } catch (...) {
      of_python = std::current_exception();
      *stop_flag_ = true;
    }
  }
  {
    const py::gil_scoped_release release;
    thread.join();
  }
  done_ = false;
  if (of_python) std::rethrow_exception(of_python);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace gatelight::python
