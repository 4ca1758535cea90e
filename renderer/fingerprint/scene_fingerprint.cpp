#include "renderer/fingerprint/scene_fingerprint.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "base/errors.h"
#include "base/file/digest.h"
#include "scene/material_fields.h"

namespace gatelight::renderer {
namespace {

template <class Values>
Digest digest_of_array(const Values& values) {
  return digest_of(std::as_bytes(std::span(values)));
}

template <class Dense>
void add_numbers(DigestRecord& record, const Eigen::DenseBase<Dense>& values) {
  for (Eigen::Index column = 0; column < values.cols(); ++column) {
    for (Eigen::Index row = 0; row < values.rows(); ++row) record.add(float{values(row, column)});
  }
}

/// An array with its length: two arrays of a mesh are never mistaken for one.
template <class Values>
void add_array(DigestRecord& record, const Values& values) {
  record.add(std::uint64_t{values.size()});
  record.add(digest_of_array(values));
}

struct MeshDigests {
  Digest geometry;
  Digest attributes;
};

MeshDigests digest_mesh(const scene::Mesh& mesh) {
  static_assert(sizeof(Vec3) == 12 && sizeof(Vec4) == 16 && sizeof(Vec2) == 8);
  DigestRecord geometry;
  add_array(geometry, mesh.positions);
  add_array(geometry, mesh.triangles);
  DigestRecord attributes;
  add_array(attributes, mesh.normals);
  add_array(attributes, mesh.tangents);
  add_array(attributes, mesh.uv0);
  add_array(attributes, mesh.uv1);
  add_array(attributes, mesh.colors);
  return {geometry.digest(), attributes.digest()};
}

void add_instance(DigestRecord& record, const scene::Instance& instance) {
  record.add(instance.mesh);
  add_numbers(record, instance.transform.matrix());
  record.add(instance.baked);
  record.add(instance.swaps_handedness);
  record.add(instance.placement);
  record.add(instance.dielectric_priority);
}

void add_slot(DigestRecord& record, const scene::TextureSlot& slot) {
  record.add(slot.texture);
  if (!slot) return;
  record.add(slot.texcoord);
  add_numbers(record, slot.transform);
}

void add_material(DigestRecord& record, const scene::Material& material) {
  const auto add = [&record](const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, Color>) {
      add_numbers(record, value);
    } else if constexpr (std::is_same_v<Value, scene::TextureSlot>) {
      add_slot(record, value);
    } else if constexpr (!std::is_same_v<Value, std::string>) {  // names decide nothing
      record.add(value);
    }
  };
  for (const scene::MaterialField& field : scene::material_fields())
    std::visit([&](auto member) { add(material.*member); }, field.member);
  record.add(material.culled);
}

void add_light(DigestRecord& record, const scene::PunctualLight& light) {
  // add_links() adds the last two.
  const auto& [name, type, intensity, position, direction, range, cos_inner, cos_outer, profile, side, rays,
               link] = light;
  record.add(type);
  add_numbers(record, intensity);
  add_numbers(record, position);
  add_numbers(record, direction);
  for (const float value : {range, cos_inner, cos_outer}) record.add(value);
  if (!profile) return;
  record.add(digest_of(std::as_bytes(std::span(profile->values()))));
  add_numbers(record, side);
}

/// Adds nothing where all rays see all objects, so that such scenes keep the fingerprints of earlier
/// versions.
void add_visibility(DigestRecord& record, const scene::Scene& scene) {
  const auto is_plain = [](const scene::Instance& i) { return i.visibility == scene::Visibility(); };
  if (std::all_of(scene.instances.begin(), scene.instances.end(), is_plain)) return;
  for (const scene::Instance& instance : scene.instances) {
    const auto& [rays, holdout, shadow_catcher] = instance.visibility;
    record.add(rays);
    record.add(holdout);
    record.add(shadow_catcher);
  }
}

/// Adds nothing where all lights light all objects for all rays.
void add_links(DigestRecord& record, const scene::Scene& scene) {
  DigestRecord links;
  bool plain = true;
  const auto add = [&](const scene::LightLink& link) {
    links.add(link.receivers);
    links.add(link.blockers);
    plain &= !link.any();
  };
  const auto add_rays = [&](scene::RayKinds rays) {
    links.add(rays);
    plain &= rays == scene::kAllRays;
  };
  for (const scene::PunctualLight& light : scene.lights) {
    add_rays(light.rays);
    add(light.link);
  }
  for (const scene::Instance& instance : scene.instances) add(instance.link);
  add_rays(scene.environment_rays);
  add(scene.environment_link);
  for (const scene::ObjectSet& set : scene.object_sets) {
    add_array(links, set.instances);
    links.add(set.fog);
  }
  if (!plain) record.add(links.digest());
}

Digest digest_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  DigestRecord record;
  std::vector<char> block(1 << 20);
  while (file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    record.add(digest_of(std::as_bytes(std::span(block).first(static_cast<std::size_t>(file.gcount())))));
  }
  if (!file.eof()) throw InputError(fmt::format("cannot read '{}'", path));
  return record.digest();
}

Digest digest_environment(const EnvironmentOptions& environment) {
  const auto& [automatic, file, constant, sky, rotation_degrees, scale, fog] = environment;
  DigestRecord record;
  record.add(automatic);
  record.add(!file.empty());
  if (!file.empty()) record.add(digest_file(file));
  if (sky) record.add_text(text_of(*sky));
  if (automatic || !file.empty() || sky) {
    record.add(rotation_degrees);
  } else {
    add_numbers(record, constant);
  }
  record.add(scale);
  if (fog) {
    record.add(fog->density);
    add_numbers(record, fog->albedo);
    record.add(fog->anisotropy);
  }
  return record.digest();
}

}  // namespace

std::string file_digest(const std::string& path) {
  return hexadecimal(digest_file(path));
}

std::string shutter_digest(const scene::Scene& scene) {
  const scene::ShutterMotion& shutter = scene.shutter;
  if (!shutter.is_open) return "";
  DigestRecord record;
  if (!shutter.clock.empty()) add_array(record, shutter.clock);
  const auto add_states = [&](const auto& lists, const auto& add) {
    for (const auto& states : lists) {
      record.add(std::uint64_t{states.size()});
      for (const auto& state : states) add(state);
    }
  };
  add_states(shutter.transforms, [&](const Affine& t) { add_numbers(record, t.matrix()); });
  add_states(shutter.vertices, [&](const scene::DeformedVertices& v) {
    add_array(record, v.positions);
    add_array(record, v.normals);
    add_array(record, v.tangents);
  });
  add_states(shutter.lights, [&](const scene::LightPlace& place) {
    add_numbers(record, place.position);
    add_numbers(record, place.direction);
    add_numbers(record, place.side);
  });
  add_states(shutter.cameras, [&](const scene::Camera& camera) {
    add_numbers(record, camera.transform.matrix());
    record.add(camera.vertical_fov);
    record.add(camera.half_height);
  });
  return hexadecimal(record.digest());
}

SceneFingerprint compute_scene_fingerprint(const scene::Scene& scene, const EnvironmentOptions& environment) {
  std::vector<MeshDigests> meshes(scene.meshes.size());
  std::vector<Digest> pixels(scene.images.size());
  tbb::parallel_for(std::size_t{0}, meshes.size() + pixels.size(), [&](std::size_t i) {
    if (i < meshes.size()) {
      meshes[i] = digest_mesh(scene.meshes[i]);
    } else {
      const scene::Image& image = scene.images[i - meshes.size()];
      pixels[i - meshes.size()] =
          image.pixels_16.empty() ? digest_of_array(image.pixels) : digest_of_array(image.pixels_16);
    }
  });

  DigestRecord geometry;
  DigestRecord attributes;
  DigestRecord materials;
  DigestRecord lights;
  geometry.add(std::uint64_t{meshes.size()});
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    geometry.add(meshes[i].geometry);
    attributes.add(meshes[i].attributes);
    materials.add(scene.meshes[i].material);
  }
  for (const scene::Instance& instance : scene.instances) add_instance(geometry, instance);
  add_visibility(geometry, scene);
  materials.add(std::uint64_t{scene.materials.size()});
  for (const scene::Material& material : scene.materials) add_material(materials, material);
  materials.add(std::uint64_t{scene.textures.size()});
  for (const scene::Texture& texture : scene.textures) {
    materials.add(texture.image);
    materials.add(texture.wrap_s);
    materials.add(texture.wrap_t);
    materials.add(texture.nearest);
  }
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    for (const int value : {scene.images[i].width, scene.images[i].height, scene.images[i].channels})
      materials.add(value);
    materials.add(pixels[i]);
  }
  for (const scene::PunctualLight& light : scene.lights) add_light(lights, light);
  if (scene.image_light) {
    const auto& [name, faces, intensity, rotation] = *scene.image_light;
    for (const scene::Image& face : faces) {
      for (const int value : {face.width, face.height, face.channels}) lights.add(value);
      lights.add(digest_of_array(face.pixels));
    }
    lights.add(intensity);
    add_numbers(lights, rotation);
  }
  add_links(lights, scene);

  return {{"geometry", hexadecimal(geometry.digest())},
          {"attributes", hexadecimal(attributes.digest())},
          {"materials", hexadecimal(materials.digest())},
          {"lights", hexadecimal(lights.digest())},
          {"environment", hexadecimal(digest_environment(environment))}};
}

}  // namespace gatelight::renderer
