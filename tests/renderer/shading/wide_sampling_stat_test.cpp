// Samples of the wide BSDF follow the density of the scalar one, and a furnace gets its light back.

#include "tests/renderer/bsdf/bsdf_cases.h"
#include "tests/renderer/bsdf/bsdf_measures.h"
#include "tests/renderer/shading/lanes.h"

namespace gatelight::renderer {
namespace {

using namespace lanes;

/// Samples of one point, 16 at a time.
class WideSamples {
 public:
  WideSamples(const SurfaceMaterial& material, const Vec3& wo, std::uint32_t seed) : seed_(seed) {
    point_.surface.geometric_normal = point_.surface.shading_normal = Vec3::UnitZ();
    point_.surface.smooth_normal = point_.surface.coat_normal = Vec3::UnitZ();
    point_.surface.material = material;
    point_.wo = wo;
  }

  BsdfSample operator()() {
    if (next_ == block_.count) refill();
    const int lane = next_++;
    BsdfSample s;
    if (!block_.alive[lane]) return s;
    s.wi = lane_vector(block_.wi, lane);
    s.weight = lane_color(block_.weight, lane);
    s.pdf = block_.pdf[lane];
    s.delta = block_.is_delta[lane] != 0;
    return s;
  }

 private:
  void refill() {
    block_ = {};
    for (int lane = 0; lane < ShadingBlock::kWidth; ++lane) {
      point_.sampler = Sampler(SamplerKind::independent, seed_, number_++, 0, 0);
      put(block_, point_);
    }
    choose_shading_kernels("auto").scatter(block_, tables_only());
    next_ = 0;
  }

  LanePoint point_;
  ShadingBlock block_ = {};
  std::uint32_t seed_;
  std::uint32_t number_ = 0;
  int next_ = 0;
};

std::vector<BsdfCase> wide_cases(std::vector<BsdfCase> cases) {
  std::erase_if(cases, [](const BsdfCase& c) {
    Surface surface;
    surface.material = c.material;
    return !kernels_shade(surface);
  });
  return cases;
}

TEST(WideSampling, SamplesFollowTheDensity) {
  constexpr int kSamples = 60000;
  std::vector<BsdfCase> cases = wide_cases(colored_cases());
  std::erase_if(cases, [](const BsdfCase& c) { return c.name == "ior 0" || c.name == "ior 3"; });
  EXPECT_GE(cases.size(), 9u);
  const std::array<float, 3> roughnesses{0.25f, 0.5f, 1.0f};
  const std::array<float, 3> cosines{1.0f, 0.5f, 0.02f};
  const double significance =
      gatelight::testing::sidak(1e-4, cases.size() * roughnesses.size() * cosines.size());
  std::uint32_t seed = 1;
  for (const BsdfCase& c : cases) {
    for (const float roughness : roughnesses) {
      for (const float cosine : cosines) {
        SCOPED_TRACE(describe(c, roughness, cosine));
        SurfaceMaterial material = c.material;
        material.roughness = roughness;
        WideSamples draw(material, incident(cosine), seed++);
        const bool narrow =
            roughness < 0.3f || (material.clearcoat > 0.0f && material.clearcoat_roughness < 0.3f);
        EXPECT_TRUE(gatelight::testing::accepts(
            samples_against_density(flat_bsdf(c, roughness, incident(cosine)), narrow ? 5 : 3, kSamples,
                                    c.symmetric(), [&] { return draw(); }),
            significance));
      }
    }
  }
}

// White surfaces give all light back, within the accuracy of the tables and of the samples.
TEST(WideSampling, AFurnaceGetsItsLightBack) {
  constexpr int kSamples = 40000;
  std::uint32_t seed = 1000;
  for (const BsdfCase& c : wide_cases(white_cases())) {
    for (const float roughness : {0.0f, 0.1f, 0.4f, 1.0f}) {
      for (const float cosine : {1.0f, 0.5f, 0.1f}) {
        SCOPED_TRACE(describe(c, roughness, cosine));
        SurfaceMaterial material = c.material;
        material.roughness = roughness;
        WideSamples draw(material, incident(cosine), seed++);
        gatelight::testing::Moments power;
        for (int i = 0; i < kSamples; ++i) power.add(static_cast<double>(draw().weight.x()));
        const auto albedo = static_cast<double>(flat_bsdf(c, roughness, incident(cosine)).albedo().x());
        EXPECT_NEAR(power.mean(), albedo, 4.5 * power.standard_error() + 5e-3);
        if (!c.layered) {
          EXPECT_NEAR(power.mean(), 1.0, 4.5 * power.standard_error() + 1.5e-2);
        }
      }
    }
  }
}

}  // namespace
}  // namespace gatelight::renderer
