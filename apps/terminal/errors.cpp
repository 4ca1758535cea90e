#include "apps/terminal/errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <new>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>

#include "apps/terminal/log.h"
#include "apps/terminal/terminal.h"
#include "apps/terminal/text.h"
#include "base/errors.h"
#include "base/file/atomic_file.h"
#include "renderer/image/image_write.h"
#include "renderer/render.h"

namespace gatelight::apps {
namespace {

struct ExitRule {
  ErrorKind kind;
  ExitCode code;
  const char* advice;
};

constexpr ExitRule kExitRules[] = {
    {ErrorKind::option, kUsage, "see --help"},
    {ErrorKind::model, kUsage, "see gatelight render --help cache"},
    {ErrorKind::format, kUsage, "choose another file name"},
    {ErrorKind::input, kInput, "check the input file"},
    {ErrorKind::cache_file, kInput,
     "use the scene and flags with which it was written, or start again without it"},
    {ErrorKind::output, kOutput, "choose another folder or free some space"},
    {ErrorKind::memory, kMemory, "raise that limit, or use a smaller picture or scene, or fewer --threads"},
    {ErrorKind::device_memory, kMemory, "lower --cache-memory or --batch, or use --device cpu"},
    {ErrorKind::unavailable, kUnavailable, "use --isa auto or --device cpu"},
    {ErrorKind::denoiser, kUnavailable,
     "check --oidn and GATELIGHT_OIDN, run scripts/setup, or use --denoiser none"},
    {ErrorKind::library, kUnavailable, "install it, or use pictures in EXR or PNG"},
    {ErrorKind::device_lost, kUnavailable, "use --device cpu"},
    {ErrorKind::numerical, kNumerical, "use --nan drop to ignore such samples"},
    {ErrorKind::training_diverged, kNumerical, "lower --learning-rate"},
    {ErrorKind::mpi, kLost, "check that all ranks run under the same MPI"},
};

Failure failure_of(const Error& error) {
  const ExitRule& rule = *std::find_if(std::begin(kExitRules), std::end(kExitRules),
                                       [&](const ExitRule& a) { return a.kind == error.kind(); });
  ErrorParts parts = error.parts();
  if (!parts.option.empty() && std::islower(static_cast<unsigned char>(parts.option.front())))
    parts.option.insert(0, "--");
  const bool plain = parts.option.empty();
  const char* const about =
      plain && error.kind() == ErrorKind::model ? "the cache cannot have these options: " : "";
  return {rule.code, about + with_flags(plain ? error.what() : sentence(parts)), rule.advice};
}

/// oneTBB throws an error of no kind where it cannot start a thread.
bool is_without_threads(const std::exception& error) {
  return std::string_view(error.what()).starts_with("pthread_create has failed");
}

std::function<void(const Failure&)>& failure_handler() {
  static std::function<void(const Failure&)> handler;
  return handler;
}

}  // namespace

Failure describe_current_exception() {
  constexpr const char* kFewerThreads = "use fewer --threads, or a machine with more memory";
  try {
    throw;
  } catch (const Error& error) {
    return failure_of(error);
  } catch (const Failure& failure) {
    return failure;
  } catch (const std::bad_alloc&) {
    return {kMemory, "out of memory", "use a smaller picture or scene, or a machine with more memory"};
  } catch (const std::system_error& error) {
    const bool is_full = error.code() == std::errc::resource_unavailable_try_again ||
                         error.code() == std::errc::not_enough_memory;
    if (!is_full) return {kInput, error.what(), "check the input file"};
    return {kMemory, fmt::format("no more threads or memory available: {}", error.what()), kFewerThreads};
  } catch (const std::exception& error) {
    if (is_without_threads(error)) return {kMemory, error.what(), kFewerThreads};
    return {kUsage, fmt::format("internal error: {}", error.what()), "please report it"};
  }
}

void end_program() {
  Failure failure{kUsage, "ended by an internal error", "please report it"};
  if (std::current_exception()) failure = describe_current_exception();
  print_failure(failure);
  std::_Exit(failure.code);
}

void handle_failures(std::function<void(const Failure&)> handler) {
  failure_handler() = std::move(handler);
}

void print_failure(const Failure& failure) {
  failure_handler() ? failure_handler()(failure) : print_failure_line(failure);
}

void print_failure_line(const Failure& failure) {
  const std::string message = one_line(failure.message);
  if (json_messages()) {
    print_json_line(
        {{"event", "error"}, {"message", message}, {"advice", failure.advice}, {"code", failure.code}});
    return;
  }
  const char* const link = failure.advice.empty() ? "" : message.ends_with('?') ? " " : "; ";
  print_status(fmt::format("gatelight: error: {}{}{}\n", message, link, failure.advice));
}

void print_notice(const std::string& text, int code) {
  if (json_messages()) {
    print_json_line({{"event", "notice"}, {"message", one_line(text)}, {"code", code}});
  } else {
    print_status(fmt::format("gatelight: {}\n", text));
  }
}

}  // namespace gatelight::apps
