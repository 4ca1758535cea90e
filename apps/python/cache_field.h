#pragma once
// A neural field on the triangles of a scene, without light transport.

#include <pybind11/pybind11.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/python/arrays.h"
#include "apps/python/waiting.h"
#include "apps/settings/render_settings.h"
#include "neural/trainer.h"
#include "scene/scene.h"

namespace gatelight::python {

/// Points as the arrays of gatelight.Points.
struct FieldPoints {
  std::vector<std::uint32_t> surfaces, triangles;
  std::vector<neural::Float2> barycentrics;
  std::vector<neural::Float3> positions, normals;

  neural::QueryBatch batch() const;
  FieldPoints chosen(const std::vector<std::size_t>& indices) const;
};

class CacheField {
 public:
  /// Options of the cache among `keywords`. `scene` holds instances with their own transforms.
  CacheField(scene::Scene scene, std::uint32_t outputs, const pybind11::dict& keywords);

  /// Throws BadOption for indices and barycentrics that are not of the scene.
  FieldPoints points(pybind11::handle instances, pybind11::handle triangles,
                     pybind11::handle barycentrics) const;
  /// Steps on batches that are drawn from the points. Returns the loss before each step.
  std::vector<double> train(const FieldPoints& points, std::span<const float> targets, int steps,
                            std::uint64_t seed, const Waiting& waiting);
  void query(const FieldPoints& points, std::span<float> out) const;
  void save(const std::string& path) const;
  void load(const std::string& path);

  std::uint32_t outputs() const { return trainer_->model().config.mlp.outputs; }
  std::uint64_t parameter_bytes() const { return trainer_->backend().parameter_bytes(); }
  std::uint64_t steps() const { return steps_; }

 private:
  scene::Scene scene_;
  apps::RenderSettings settings_;
  std::string fingerprint_;
  std::unique_ptr<neural::Trainer> trainer_;
  std::uint64_t steps_ = 0;
};

/// Outputs and options of a file of CacheField::save(). Throws CacheFileError.
std::pair<std::uint32_t, pybind11::dict> field_options(const std::string& path);

}  // namespace gatelight::python
