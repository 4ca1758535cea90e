#include "apps/terminal/errors.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>

#include "apps/terminal/log.h"
#include "apps/terminal/terminal.h"
#include "neural/base/errors.h"
#include "renderer/image/image_write.h"
#include "renderer/machine/atomic_file.h"
#include "renderer/render.h"

namespace gatelight::apps {
namespace {

/// What oneTBB throws where it cannot start a thread.
constexpr std::string_view kThreadFailed = "pthread_create has failed";

std::function<void(const Failure&)>& failure_handler() {
  static std::function<void(const Failure&)> handler;
  return handler;
}

}  // namespace

Failure describe_current_exception() {
  try {
    throw;
  } catch (const UsageError& error) {
    return {kUsage, error.what(), "see --help"};
  } catch (const neural::BadConfiguration& error) {
    return {kUsage, fmt::format("the cache cannot be as asked: {}", error.what()),
            "see gatelight render --help cache"};
  } catch (const renderer::UnknownFormat& error) {
    return {kUsage, error.what(), "choose another file name"};
  } catch (const renderer::OutputError& error) {
    return {kOutput, error.what(), "choose another place or make room"};
  } catch (const renderer::OutOfMemory& error) {
    return {kMemory, error.what(), "raise that limit, or use a smaller picture or scene, or fewer --threads"};
  } catch (const neural::OutOfDeviceMemory& error) {
    return {kMemory, error.what(), "lower --cache-memory or --batch, or use --device cpu"};
  } catch (const std::bad_alloc&) {
    return {kMemory, "out of memory", "use a smaller picture or scene, or a machine with more memory"};
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::resource_unavailable_try_again ||
        error.code() == std::errc::not_enough_memory) {
      return {kMemory, fmt::format("no more threads or memory to be had: {}", error.what()),
              "use fewer --threads, or a machine with more memory"};
    }
    return {kInput, error.what(), "check the input file"};
  } catch (const renderer::MissingDenoiser& error) {
    return {kUnavailable, error.what(),
            "check --oidn and GATELIGHT_OIDN, run scripts/setup, or use --denoiser none"};
  } catch (const renderer::Unavailable& error) {
    return {kUnavailable, error.what(), "use --isa auto or --device cpu"};
  } catch (const renderer::MissingLibrary& error) {
    return {kUnavailable, error.what(), "install it, or use pictures in EXR or PNG"};
  } catch (const neural::DeviceLost& error) {
    return {kUnavailable, error.what(), "use --device cpu"};
  } catch (const neural::Unavailable& error) {
    return {kUnavailable, error.what(), "use --isa auto or --device cpu"};
  } catch (const renderer::TrainingDiverged& error) {
    return {kNumerical, error.what(), "lower --learning-rate"};
  } catch (const renderer::NumericalError& error) {
    return {kNumerical, error.what(), "use --nan drop to leave such samples out"};
  } catch (const neural::CacheFileError& error) {
    return {kInput, error.what(), "use the scene and flags that it was written with, or begin anew"};
  } catch (const std::runtime_error& error) {
    if (std::string_view(error.what()).starts_with(kThreadFailed)) {
      return {kMemory, error.what(), "use fewer --threads, or a machine with more memory"};
    }
    // Libraries throw these for files: scene::SceneError, renderer::ImageError and the environment's errors.
    return {kInput, error.what(), "check the input file"};
  } catch (const std::exception& error) {
    return {kUsage, fmt::format("internal error: {}", error.what()), "please report it"};
  }
}

std::string one_line(std::string text) {
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) c = ' ';
  }
  return text;
}

void end_program() {
  Failure failure{kUsage, "ended by a failure of its own", "please report it"};
  if (std::current_exception()) failure = describe_current_exception();
  print_failure(failure);
  std::_Exit(failure.code);
}

void handle_failures(std::function<void(const Failure&)> handler) {
  failure_handler() = std::move(handler);
}

void print_failure(const Failure& failure) {
  failure_handler() ? failure_handler()(failure) : tell_failure(failure);
}

void tell_failure(const Failure& failure) {
  const std::string message = one_line(failure.message);
  if (json_messages()) {
    print_json_line(
        {{"event", "error"}, {"message", message}, {"advice", failure.advice}, {"code", failure.code}});
    return;
  }
  const char* const link = failure.advice.empty() ? "" : message.ends_with('?') ? " " : "; ";
  tell(fmt::format("gatelight: error: {}{}{}\n", message, link, failure.advice));
}

void print_notice(const std::string& text, int code) {
  if (json_messages()) {
    print_json_line({{"event", "notice"}, {"message", one_line(text)}, {"code", code}});
  } else {
    tell(fmt::format("gatelight: {}\n", text));
  }
}

}  // namespace gatelight::apps
