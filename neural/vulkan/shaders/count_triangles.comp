#version 460
// Increments the count of each triangle with an accepted record, once per step: the thread that stamps it
// first does.

#include "blocks.glsl"

void main() {
  const uint record = flat_thread();
  if (record >= batch.size || batch.status.at[record] != kStatusAccepted) return;
  const uint triangle = batch.record_triangles.at[record];
  Words stamps = part_of(model.triangle_stamps, triangle);
  const uint stamp = model.progress.at[0] + 1u;
  if (atomicExchange(stamps.at[place_in_part(model.triangle_stamps, triangle)], stamp) == stamp) return;
  Words steps = part_of(model.triangle_steps, triangle);
  const uint at = place_in_part(model.triangle_steps, triangle);
  if (steps.at[at] != 0xffffffffu) steps.at[at] += 1u;
}
