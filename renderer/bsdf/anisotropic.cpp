#include "renderer/bsdf/anisotropic.h"

#include <tbb/parallel_for.h>

#include "renderer/bsdf/quadrature.h"

namespace gatelight::renderer {
namespace {

constexpr int kNodes = AnisotropicTables::kCosine * AnisotropicTables::kTurn;

struct Alphas {
  float x, y;
};
Alphas alphas_of(float roughness, float strength) {
  const float y = std::max(roughness * roughness, kDeltaAlpha);
  return {y + (1.0f - y) * strength * strength, y};
}

/// Two neighbours in a table, and the share of the second.
struct Between {
  int index;
  float share;
  Between(float x, int count)
      : index(std::clamp(static_cast<int>(x), 0, count - 2)), share(x - static_cast<float>(index)) {}
};

/// The coordinates of a direction in a slice. Smith's masking of a direction is that of an isotropic surface
/// with the alpha of its projection, so both depend on that: near the horizon the loss is a function of
/// cosine / alpha, as in GgxTables, and around the normal alpha itself is the coordinate.
struct Place {
  Between cosine, turn;

  Place(const Alphas& a, float cosine_o, float along2) : Place(a, cosine_o, along2, projected(a, along2)) {}

 private:
  static float projected(const Alphas& a, float along2) {
    return std::sqrt(a.y * a.y + (a.x * a.x - a.y * a.y) * along2);
  }
  Place(const Alphas& a, float cosine_o, float along2, float alpha)
      : cosine(cosine_o * (1.0f + alpha) / (cosine_o + alpha) * (AnisotropicTables::kCosine - 1),
               AnisotropicTables::kCosine),
        turn(along2 * (a.x + a.y) / (alpha + a.y) * (AnisotropicTables::kTurn - 1),
             AnisotropicTables::kTurn) {}
};

/// The direction of a node: its cosine, and along2.
struct Node {
  float cosine, along2;

  Node(const Alphas& a, int cosine_node, int turn_node) {
    const float v = static_cast<float>(turn_node) / (AnisotropicTables::kTurn - 1);
    const float alpha = a.y + v * (a.x - a.y);
    along2 = v * (alpha + a.y) / (a.x + a.y);
    cosine = table_cosine(static_cast<float>(cosine_node) / (AnisotropicTables::kCosine - 1), alpha);
  }
  Vec3 direction() const {
    const float sine = std::sqrt(1.0f - cosine * cosine);
    return {sine * std::sqrt(along2), sine * std::sqrt(std::max(0.0f, 1.0f - along2)), cosine};
  }
};

/// The light that goes from each node (row) to each other one.
struct Exchange {
  std::vector<float> cells = std::vector<float>(kNodes * kNodes, 0.0f);

  void add(int row, const Place& to, float amount) {
    for (const int i : {0, 1}) {
      for (const int j : {0, 1}) {
        const float share = (i != 0 ? to.cosine.share : 1.0f - to.cosine.share) *
                            (j != 0 ? to.turn.share : 1.0f - to.turn.share);
        const int column = (to.cosine.index + i) * AnisotropicTables::kTurn + to.turn.index + j;
        cells[static_cast<std::size_t>(row * kNodes + column)] += amount * share;
      }
    }
  }
  float row_sum(int row, const std::array<float, kNodes>& factors) const {
    float sum = 0.0f;
    for (int i = 0; i < kNodes; ++i) sum += cells[static_cast<std::size_t>(row * kNodes + i)] * factors[i];
    return sum;
  }
};

}  // namespace

void AnisotropicTables::fill(Slice& slice, float alpha_x, float alpha_y) const {
  const Alphas a{alpha_x, alpha_y};
  const auto root = [&](const Vec3& w) { return Vec3(a.x * w.x(), a.y * w.y(), w.z()).norm(); };
  Exchange all, grazing;
  for (int node = 0; node < kNodes; ++node) {
    const Vec3 wo = Node(a, node / kTurn, node % kTurn).direction();
    const float root_o = root(wo);
    // The lattice is symmetric about the plane of wo in the space where the lobe is a hemisphere.
    const float turn = std::atan2(a.y * wo.y(), a.x * wo.x()) * kInvTwoPi;
    for (const LatticePoint& point : half_lattice<377, 233>()) {
      for (const float side : {-1.0f, 1.0f}) {
        const float u = turn + side * point.u.x();
        const Vec3 h = sample_visible_normal(a.x, a.y, wo, {u < 0.0f ? u + 1.0f : u, point.u.y()});
        const float oh = wo.dot(h);
        const Vec3 wi = 2.0f * oh * h - wo;
        if (!(wi.z() > 0.0f)) continue;
        const float kept = smith_ratio(wo.z(), root_o, wi.z(), root(wi));
        const float across2 = wi.x() * wi.x() + wi.y() * wi.y();
        const Place to(a, std::min(wi.z(), 1.0f), across2 > 0.0f ? wi.x() * wi.x() / across2 : 0.0f);
        all.add(node, to, 0.5f * point.weight * kept);
        grazing.add(node, to, 0.5f * point.weight * kept * schlick_weight(oh));
      }
    }
  }
  const std::array<float, kNodes> scale = balance<kNodes>(all);
  std::array<float, kNodes> ones;
  ones.fill(1.0f);
  for (int i = 0; i < kNodes; ++i) {
    const float schlick = schlick_weight(Node(a, i / kTurn, i % kTurn).cosine);
    const float kept = all.row_sum(i, ones);
    slice[i / kTurn][i % kTurn] = {1.0f - kept, grazing.row_sum(i, ones) - kept * schlick,
                                   scale[i] * grazing.row_sum(i, scale) - schlick, scale[i]};
  }
}

AnisotropicTables::AnisotropicTables() : slices_(kRoughness * kStrength), means_(slices_.size()) {
  const auto alphas = [](std::size_t i) {
    return alphas_of(static_cast<float>(i / kStrength) / (kRoughness - 1),
                     static_cast<float>(i % kStrength) / (kStrength - 1));
  };
  tbb::parallel_for(std::size_t{0}, slices_.size(), [&](std::size_t i) {
    const Alphas a = alphas(i);
    fill(slices_[i], a.x, a.y);
  });
  // As in GgxTables, the means are those of the interpolated table.
  tbb::parallel_for(std::size_t{0}, means_.size(), [&](std::size_t i) {
    const Row own = row(static_cast<float>(i / kStrength) / (kRoughness - 1),
                        static_cast<float>(i % kStrength) / (kStrength - 1));
    constexpr int kTurns = 16;
    GgxAlbedo mean{0.0f, 0.0f, 0.0f, 1.0f};
    for (int t = 0; t < kTurns; ++t) {
      const float c = std::cos((static_cast<float>(t) + 0.5f) * (0.5f * kPi / kTurns));
      for_mean_cosines([&](float cosine, float weight) {
        const GgxAlbedo albedo = own.at(cosine, c * c);
        mean.loss += weight / kTurns * albedo.loss;
        mean.b += weight / kTurns * albedo.b;
        mean.b_scaled += weight / kTurns * albedo.b_scaled;
      });
    }
    means_[i] = mean;
  });
}

const AnisotropicTables& AnisotropicTables::get() {
  static const AnisotropicTables tables;
  return tables;
}

AnisotropicTables::Row AnisotropicTables::row(float roughness, float strength) const {
  Row row;
  const Alphas a = alphas_of(roughness, strength);
  row.alpha_x = a.x;
  row.alpha_y = a.y;
  const Between r(roughness * (kRoughness - 1), kRoughness), s(strength * (kStrength - 1), kStrength);
  row.slice = &slices_[static_cast<std::size_t>(r.index * kStrength + s.index)];
  row.roughness_mix = r.share;
  row.strength_mix = s.share;
  const auto mix = [&](float GgxAlbedo::*part) {
    const auto of = [&](int i, int j) {
      return means_[static_cast<std::size_t>((r.index + i) * kStrength + s.index + j)].*part;
    };
    const float low = of(0, 0) + s.share * (of(0, 1) - of(0, 0));
    const float high = of(1, 0) + s.share * (of(1, 1) - of(1, 0));
    return low + r.share * (high - low);
  };
  row.mean = {mix(&GgxAlbedo::loss), mix(&GgxAlbedo::b), mix(&GgxAlbedo::b_scaled), 1.0f};
  return row;
}

GgxAlbedo AnisotropicTables::Row::at(float cosine, float along2) const {
  const Place place({alpha_x, alpha_y}, cosine, along2);
  Entry entry{};
  for (const int r : {0, 1}) {
    for (const int s : {0, 1}) {
      const Slice& of = slice[r * kStrength + s];
      const float share =
          (r != 0 ? roughness_mix : 1.0f - roughness_mix) * (s != 0 ? strength_mix : 1.0f - strength_mix);
      for (const int i : {0, 1}) {
        for (const int j : {0, 1}) {
          const float weight = share * (i != 0 ? place.cosine.share : 1.0f - place.cosine.share) *
                               (j != 0 ? place.turn.share : 1.0f - place.turn.share);
          const Entry& node = of[place.cosine.index + i][place.turn.index + j];
          for (std::size_t k = 0; k < entry.size(); ++k) entry[k] += weight * node[k];
        }
      }
    }
  }
  const float schlick = schlick_weight(cosine);
  return {entry[0], entry[1] + (1.0f - entry[0]) * schlick, entry[2] + schlick, entry[3]};
}

AnisotropicLobe::AnisotropicLobe(float roughness, float strength, const Vec3& direction, const Vec3& normal)
    : n(normal), row(AnisotropicTables::get().row(roughness, strength)) {
  alpha_x = row.alpha_x;
  alpha_y = row.alpha_y;
  const Vec3 across = normal.cross(direction);
  const float length = across.norm();
  y = length > 1e-6f ? Vec3(across / length) : Basis(normal).bitangent;
  x = y.cross(normal);
}

}  // namespace gatelight::renderer
