#pragma once
// Every fast backend of this machine, and the reference in double precision beside it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "tests/neural/extreme_batches.h"
#include "tests/support/agreement.h"

namespace gatelight::neural::testing {

/// Scalar, AVX2 and AVX-512, as far as the processor has them.
inline std::vector<std::unique_ptr<Backend>> fast_backends(const std::shared_ptr<const Model>& model,
                                                           const TrainingOptions& options) {
  std::vector<std::unique_ptr<Backend>> backends;
  for (const simd::Isa isa : simd::available_isas())
    backends.push_back(cpu::make_cpu_backend(model, options, isa));
  return backends;
}

inline std::vector<NamedBackend> named_backends(const std::shared_ptr<const Model>& model,
                                                const TrainingOptions& options) {
  std::vector<NamedBackend> backends;
  for (auto& backend : fast_backends(model, options)) {
    const std::string name = backend->name();
    backends.push_back({name, std::move(backend)});
  }
  return backends;
}

/// Compares the fast backends with the reference: answers before and all that steps change. The options must
/// make a step a smooth function of the gradient (make_smooth), and the batch must stay away from kinks.
class FastAgreement : public Agreement {
 public:
  explicit FastAgreement(Makers make = named_backends) : Agreement(std::move(make), false) {}

  void expect_same(const std::string& where, const ModelCase& c, const TrainingOptions& options,
                   const ModelState& state, const OwnedBatch& batch, int steps = 1) {
    const ModelCase named{where + ": " + c.name, c.model};
    expect_same_answers(named, options, batch, state);
    expect_same_step(named.name, c.model, options, batch, state, steps);
  }
};

inline bool all_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

/// The worst difference of answers from the reference, over every fast backend.
inline double worst_answers(const ModelCase& c, const TrainingOptions& options, const ModelState& state,
                            const OwnedBatch& batch) {
  const auto reference = reference::make_reference_backend(c.model, options);
  reference->import_state(state);
  const std::vector<float> expected = raw_answers(*reference, *c.model, batch);
  double worst = 0;
  for (const auto& fast : fast_backends(c.model, options)) {
    fast->import_state(state);
    worst = std::max(worst, relative_difference(raw_answers(*fast, *c.model, batch), expected));
  }
  return worst;
}

}  // namespace gatelight::neural::testing
