#include "apps/errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <new>

#include "neural/errors.h"
#include "renderer/atomic_file.h"
#include "renderer/image_write.h"
#include "renderer/render.h"

namespace gatelight::apps {

Failure describe_current_exception() {
  try {
    throw;
  } catch (const UsageError& error) {
    return {kUsage, error.what(), "see --help"};
  } catch (const renderer::BadOption& error) {
    return {kUsage, error.what(), "see --help"};
  } catch (const neural::BadConfiguration& error) {
    return {kUsage, fmt::format("the cache cannot be as asked: {}", error.what()),
            "see 'Cache' in gatelight render --help"};
  } catch (const renderer::UnknownFormat& error) {
    return {kUsage, error.what(), "choose another file name"};
  } catch (const renderer::OutputError& error) {
    return {kOutput, error.what(), "choose another place or make room"};
  } catch (const neural::CacheWriteError& error) {
    return {kOutput, error.what(), "choose another place or make room"};
  } catch (const renderer::OutOfMemory& error) {
    return {kMemory, error.what(), "raise --memory-limit, or use a smaller picture or scene"};
  } catch (const std::bad_alloc&) {
    return {kMemory, "out of memory", "use a smaller picture or scene, or a machine with more memory"};
  } catch (const renderer::Unavailable& error) {
    return {kUnavailable, error.what(), "use --isa auto or --device cpu"};
  } catch (const neural::Unavailable& error) {
    return {kUnavailable, error.what(), "use --isa auto or --device cpu"};
  } catch (const renderer::TrainingDiverged& error) {
    return {kNumerical, error.what(), "lower --learning-rate"};
  } catch (const renderer::NumericalError& error) {
    return {kNumerical, error.what(), "use --nan drop to leave such samples out"};
  } catch (const neural::CacheFileError& error) {
    return {kInput, error.what(), "use the scene and flags that it was written with, or begin anew"};
  } catch (const std::runtime_error& error) {
    // What libraries throw for files: scene::SceneError, renderer::ImageError and the environment's.
    return {kInput, error.what(), "check the input file"};
  } catch (const std::exception& error) {
    return {kUsage, fmt::format("internal error: {}", error.what()), "please report it"};
  }
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

void print_failure(const Failure& failure) {
  std::string line = one_line(failure.message);
  if (!failure.advice.empty()) line += "; " + failure.advice;
  fmt::print(stderr, "gatelight: error: {}\n", line);
}

void print_notice(const std::string& text) {
  fmt::print(stderr, "gatelight: {}\n", text);
}

}  // namespace gatelight::apps
