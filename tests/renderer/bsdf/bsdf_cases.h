#pragma once
// The materials that the tests of the BSDF go through: every lobe, and mixtures.

#include <array>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "renderer/bsdf/bsdf.h"

namespace gatelight::renderer {

struct BsdfCase {
  std::string name;
  SurfaceMaterial material;
  bool front = true;
  bool layered = false;  ///< clearcoat or sheen

  /// Whether the material is symmetric about the xz plane.
  bool symmetric() const {
    return material.anisotropy == 0.0f ||
           std::abs(material.anisotropy_direction.x() * material.anisotropy_direction.y()) < 1e-3f;
  }
};

namespace detail {

template <typename Change>
void add(std::vector<BsdfCase>& cases, const char* name, bool front, bool layered, Change&& change) {
  SurfaceMaterial material;
  material.diffuse_transmission_color.setOnes();
  material.anisotropy_direction = Vec3::UnitX();
  change(material);
  cases.push_back({name, material, front, layered});
}

inline auto glass(float ior, float transmission) {
  return [=](SurfaceMaterial& m) {
    m.transmission = transmission;
    m.thin_walled = false;
    m.ior = ior;
  };
}

inline auto film(float film_ior, float thickness) {
  return [=](SurfaceMaterial& m) {
    m.iridescence = 1.0f;
    m.film_ior = film_ior;
    m.film_thickness = thickness;
  };
}

inline auto anisotropic(float strength, float turn) {
  return [=](SurfaceMaterial& m) {
    m.metallic = 1.0f;
    m.anisotropy = strength;
    m.anisotropy_direction = Vec3(std::cos(turn), std::sin(turn), 0.0f);
  };
}

inline void add_opaque_and_thin(std::vector<BsdfCase>& cases) {
  add(cases, "dielectric", true, false, [](SurfaceMaterial&) {});
  add(cases, "metal", true, false, [](SurfaceMaterial& m) { m.metallic = 1.0f; });
  add(cases, "half metal", true, false, [](SurfaceMaterial& m) { m.metallic = 0.5f; });
  add(cases, "ior 3", true, false, [](SurfaceMaterial& m) { m.ior = 3.0f; });
  add(cases, "ior 1", true, false, [](SurfaceMaterial& m) { m.ior = 1.0f; });
  add(cases, "ior 0", true, false, [](SurfaceMaterial& m) { m.ior = 0.0f; });
  add(cases, "specular 0.3", true, false, [](SurfaceMaterial& m) { m.specular = 0.3f; });
  add(cases, "thin", true, false, [](SurfaceMaterial& m) { m.transmission = 1.0f; });
}

inline void add_glasses(std::vector<BsdfCase>& cases) {
  add(cases, "into glass", true, false, glass(1.5f, 1.0f));
  add(cases, "out of glass", false, false, glass(1.5f, 1.0f));
  add(cases, "into water", true, false, glass(1.33f, 1.0f));
  add(cases, "out of water", false, false, glass(1.33f, 1.0f));
  add(cases, "into ior 3", true, false, glass(3.0f, 1.0f));
  add(cases, "out of ior 3", false, false, glass(3.0f, 1.0f));
  add(cases, "clear", true, false, glass(1.0f, 1.0f));
  add(cases, "half glass", true, false, glass(1.5f, 0.5f));
}

inline void add_diffuse_transmission(std::vector<BsdfCase>& cases) {
  add(cases, "cloth", true, false, [](SurfaceMaterial& m) { m.diffuse_transmission = 0.6f; });
  add(cases, "paper, all through", true, false, [](SurfaceMaterial& m) {
    m.diffuse_transmission = 1.0f;
    m.ior = 2.0f;
  });
  add(cases, "cloth and sheet", true, false, [](SurfaceMaterial& m) {
    m.diffuse_transmission = 0.5f;
    m.transmission = 0.5f;
  });
  const auto milky = [](SurfaceMaterial& m) {
    glass(1.5f, 0.5f)(m);
    m.diffuse_transmission = 0.7f;
  };
  add(cases, "into milky glass", true, false, milky);
  add(cases, "out of milky glass", false, false, milky);
  add(cases, "coat on cloth", true, true, [](SurfaceMaterial& m) {
    m.diffuse_transmission = 0.5f;
    m.clearcoat = 1.0f;
    m.clearcoat_roughness = 0.3f;
  });
}

inline void add_films(std::vector<BsdfCase>& cases) {
  add(cases, "film on plastic", true, false, film(1.3f, 400.0f));
  add(cases, "soap bubble", true, false, [](SurfaceMaterial& m) {
    film(1.33f, 520.0f)(m);
    m.transmission = 1.0f;
    m.ior = 1.0f;
  });
  add(cases, "film on sheet", true, false, [](SurfaceMaterial& m) {
    film(1.8f, 300.0f)(m);
    m.transmission = 1.0f;
  });
  add(cases, "film on glass", true, false, [](SurfaceMaterial& m) {
    glass(1.5f, 1.0f)(m);
    film(1.3f, 250.0f)(m);
  });
  add(cases, "out of glass with a film", false, false, [](SurfaceMaterial& m) {
    glass(1.5f, 1.0f)(m);
    film(1.3f, 250.0f)(m);
  });
}

inline void add_anisotropic(std::vector<BsdfCase>& cases) {
  add(cases, "anisotropic along", true, false, anisotropic(0.7f, 0.0f));
  add(cases, "anisotropic across", true, false, anisotropic(0.7f, 1.5708f));
  add(cases, "anisotropic askew", true, false, anisotropic(0.45f, 0.6f));
  add(cases, "fully anisotropic", true, false, anisotropic(1.0f, 2.5f));
  add(cases, "anisotropic plastic", true, false, [](SurfaceMaterial& m) {
    m.anisotropy = 0.6f;
    m.ior = 2.0f;
  });
  add(cases, "anisotropic sheet", true, false, [](SurfaceMaterial& m) {
    anisotropic(0.5f, 0.9f)(m);
    m.metallic = 0.0f;
    m.transmission = 1.0f;
  });
}

inline void add_layered(std::vector<BsdfCase>& cases) {
  add(cases, "coat", true, true, [](SurfaceMaterial& m) {
    m.clearcoat = 1.0f;
    m.clearcoat_roughness = 0.4f;
  });
  add(cases, "smooth coat on metal", true, true, [](SurfaceMaterial& m) {
    m.clearcoat = 0.7f;
    m.metallic = 1.0f;
  });
  add(cases, "sheen", true, true, [](SurfaceMaterial& m) {
    m.sheen_color = Color(1.0f, 1.0f, 1.0f);
    m.sheen_roughness = 0.5f;
  });
  add(cases, "rough sheen under coat", true, true, [](SurfaceMaterial& m) {
    m.sheen_color = Color(0.5f, 0.5f, 0.5f);
    m.sheen_roughness = 1.0f;
    m.clearcoat = 0.5f;
    m.clearcoat_roughness = 0.2f;
  });
}

}  // namespace detail

/// White materials: their albedo is one.
inline std::vector<BsdfCase> white_cases() {
  std::vector<BsdfCase> cases;
  detail::add_opaque_and_thin(cases);
  detail::add_glasses(cases);
  detail::add_diffuse_transmission(cases);
  detail::add_films(cases);
  detail::add_anisotropic(cases);
  detail::add_layered(cases);
  return cases;
}

/// The same with colours, so that the chances of the lobes differ from their shares in white.
inline std::vector<BsdfCase> colored_cases() {
  std::vector<BsdfCase> cases = white_cases();
  for (BsdfCase& c : cases) {
    c.material.base_color = Color(0.8f, 0.4f, 0.1f);
    c.material.specular_color = Color(0.9f, 1.0f, 0.5f);
    c.material.diffuse_transmission_color = Color(0.3f, 0.9f, 0.6f);
    c.material.sheen_color *= Color(0.2f, 0.7f, 0.9f);
  }
  return cases;
}

/// A direction in the xz plane around +z.
inline Vec3 incident(float cosine) {
  return {std::sqrt(1.0f - cosine * cosine), 0.0f, cosine};
}

inline Bsdf flat_bsdf(const BsdfCase& c, float roughness, const Vec3& wo) {
  SurfaceMaterial material = c.material;
  material.roughness = roughness;
  const Vec3 n = Vec3::UnitZ();
  return Bsdf(material, n, n, n, wo, c.front);
}

/// The wide and the narrow part of a surface.
inline std::array<Bsdf, 2> parts(const Bsdf& whole, float roughness) {
  return {whole.wide_part(roughness), whole.narrow_part(roughness)};
}

inline std::string describe(const BsdfCase& c, float roughness, float cosine) {
  return c.name + ", roughness " + std::to_string(roughness) + ", cosine " + std::to_string(cosine);
}

}  // namespace gatelight::renderer
