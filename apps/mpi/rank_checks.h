#pragma once
// Checks and choices that the ranks make together before anything is built.

#include "apps/mpi/mpi_collectives.h"
#include "apps/settings/render_settings.h"
#include "scene/scene.h"

namespace gatelight::apps {

/// Ranks that share the processors of a machine, and are not bound to some of them, share the threads.
/// Processors of different instruction sets use the ones that all have. All ranks call it.
void share_machines(RenderSettings& settings, MpiCollectives& all);

/// Throws InputError at all ranks, naming the first that has another version, other options or another scene
/// than rank 0.
void expect_equal_ranks(const RenderSettings& settings, const scene::Scene& scene, MpiCollectives& all);

/// Throws OutOfMemory at all ranks, naming the machine, where its ranks need more memory together
/// than it has left.
void require_memory_of_ranks(const RenderSettings& settings, const scene::Scene& scene, MpiCollectives& all);

}  // namespace gatelight::apps
