// Compiled twice (CMakeLists.txt); GATELIGHT_EIGEN_CHUNK names the function. The namespace Eigen is renamed.
// Otherwise the linker could use its inline functions in the rest of the program, which must run on any
// processor.
#define Eigen GATELIGHT_EIGEN_NAMESPACE
#include "bench/mlp_eigen.h"

#include <Eigen/Core>

namespace gatelight::bench {

namespace {

using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Weights = Eigen::Map<const RowMajor>;
using Gradients = Eigen::Map<RowMajor>;
// A sample is a column. Its inputs are contiguous, like the rows of the caller's arrays.
using Samples = Eigen::MatrixXf;

constexpr float kSlope = 0.01f;
constexpr int kInputs = EigenNetwork::kInputs, kWidth = EigenNetwork::kWidth,
              kOutputs = EigenNetwork::kOutputs, kFeatureInputs = EigenNetwork::kFeatureInputs;

struct Scratch {
  Samples h1, h2, y, d1, d2, dy;
};

}  // namespace

float GATELIGHT_EIGEN_CHUNK(const EigenNetwork& network, const float* inputs, const float* targets,
                            int samples, float* gradients, float* feature_gradients) {
  static thread_local Scratch s;
  const Weights w1(network.weights, kWidth, kInputs);
  const Weights w2(w1.data() + w1.size(), kWidth, kWidth);
  const Weights w3(w2.data() + w2.size(), kOutputs, kWidth);
  Gradients g1(gradients, kWidth, kInputs);
  Gradients g2(g1.data() + g1.size(), kWidth, kWidth);
  Gradients g3(g2.data() + g2.size(), kOutputs, kWidth);
  const Eigen::Map<const Samples> x(inputs, kInputs, samples);
  const Eigen::Map<const Samples> t(targets, kOutputs, samples);
  Eigen::Map<Samples> dx(feature_gradients, kFeatureInputs, samples);

  s.h1.noalias() = w1 * x;
  s.h1 = s.h1.cwiseMax(kSlope * s.h1);
  s.h2.noalias() = w2 * s.h1;
  s.h2 = s.h2.cwiseMax(kSlope * s.h2);
  s.y.noalias() = w3 * s.h2;
  s.dy = s.y - t;
  const float loss = s.dy.squaredNorm();
  g3.noalias() += s.dy * s.h2.transpose();
  s.d2.noalias() = w3.transpose() * s.dy;
  s.d2.array() *= (s.h2.array() > 0.0f).select(1.0f, Eigen::ArrayXXf::Constant(kWidth, samples, kSlope));
  g2.noalias() += s.d2 * s.h1.transpose();
  s.d1.noalias() = w2.transpose() * s.d2;
  s.d1.array() *= (s.h1.array() > 0.0f).select(1.0f, Eigen::ArrayXXf::Constant(kWidth, samples, kSlope));
  g1.noalias() += s.d1 * x.transpose();
  dx.noalias() = w1.leftCols(kFeatureInputs).transpose() * s.d1;
  return loss;
}

}  // namespace gatelight::bench
