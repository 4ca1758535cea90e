#version 460
// Applies Adam to feature vectors and updates their averages, one node per thread: to touched nodes with
// their own counters, or to every node with the global step count (dense). Push::argument is the array with the
// sorted references.

#include "blocks.glsl"
#include "adam.glsl"
#include "halves.glsl"
#include "runs.glsl"

layout(constant_id = 0) const uint kFeatures = 1;
layout(constant_id = 1) const bool kPerTriangle = false;
layout(constant_id = 2) const bool kDense = false;
layout(constant_id = 3) const bool kFloats = true;   // parameters or masters
layout(constant_id = 4) const bool kHalves = false;  // read by the forward pass
layout(constant_id = 5) const bool kAverages = true;

const float kMaxHalf = 65504.0;
const uint kNone = 0xffffffffu;

shared uint runs[kThreads];
shared uint run_count;

float gradient[kFeatures];
float changed[kFeatures];
float average[kFeatures];

uint run_of(uint node) {
  const uint run = first_from(0u, node);
  return run < batch.references && node_at(run) == node ? run : kNone;
}

// The first reference behind the run, or behind its only piece.
uint end_of(uint run, uint node) {
  const uint next = next_piece(run);
  return next < batch.references && node_at(next) == node ? first_from(next, node + 1u) : next;
}

void sum_gradient(uint run, uint end) {
  for (uint f = 0u; f < kFeatures; ++f) gradient[f] = 0.0;
  for (uint piece = run; piece < end; piece = next_piece(piece))
    for (uint f = 0u; f < kFeatures; ++f) gradient[f] += batch.piece_sums.at[piece * kFeatures + f];
  const float scale = gradient_scale();
  for (uint f = 0u; f < kFeatures; ++f) gradient[f] *= scale;
}

bool usable() {
  for (uint f = 0u; f < kFeatures; ++f)
    if (!finite(gradient[f] * gradient[f])) return false;
  return true;
}

uint triangle_step(uint run, uint end) {
  uint greatest = 0u;
  for (uint piece = run; piece < end; piece = next_piece(piece))
    greatest = max(greatest, batch.piece_steps.at[piece]);
  return greatest;
}

float read_float(Table table, uint node, uint f) {
  return uintBitsToFloat(part_of(table, node).at[place_in_part(table, node) + f]);
}

float read_half(Table table, uint node, uint f) {
  const uint word = part_of(table, node).at[place_in_part(table, node) + f / 2u];
  return f % 2u == 0u ? first_half(word) : second_half(word);
}

float clamped_to_half(float x) {
  return clamp(x, -kMaxHalf, kMaxHalf);
}

void write_floats(Table table, uint node, float values[kFeatures]) {
  Words part = part_of(table, node);
  const uint at = place_in_part(table, node);
  for (uint f = 0u; f < kFeatures; ++f) part.at[at + f] = floatBitsToUint(values[f]);
}

void write_halves(Table table, uint node, float values[kFeatures]) {
  Words part = part_of(table, node);
  const uint at = place_in_part(table, node);
  for (uint f = 0u; f < kFeatures; f += 2u) {
    const uint low = float_to_half(clamped_to_half(values[f]));
    const uint high = f + 1u < kFeatures ? float_to_half(clamped_to_half(values[min(f + 1u, kFeatures - 1u)])) : 0u;
    part.at[at + f / 2u] = high << 16 | low;
  }
}

void move(uint node, AdamStep adam) {
  Words moments = part_of(model.moments, node);
  const uint at = place_in_part(model.moments, node);
  for (uint f = 0u; f < kFeatures; ++f) {
    const float g = gradient[f];
    const float m = uintBitsToFloat(moments.at[at + f]) * model.adam.beta1 + g * (1.0 - model.adam.beta1);
    const float v =
        uintBitsToFloat(moments.at[at + kFeatures + f]) * model.adam.beta2 + g * g * (1.0 - model.adam.beta2);
    moments.at[at + f] = floatBitsToUint(m);
    moments.at[at + kFeatures + f] = floatBitsToUint(v);
    const float before = kFloats ? read_float(model.features, node, f) : read_half(model.halves, node, f);
    const float after = before - moved(m, v, adam);
    changed[f] = kHalves ? clamped_to_half(after) : after;
  }
}

// With fp16 without masters an average follows the rounded feature.
void follow(uint node, AdamStep adam) {
  for (uint f = 0u; f < kFeatures; ++f) {
    const float target = kFloats ? changed[f] : half_to_float(float_to_half(changed[f]));
    const float before =
        kFloats ? read_float(model.averages, node, f) : read_half(model.average_halves, node, f);
    average[f] = before + (target - before) * adam.average_rate;
  }
}

void update(uint node, AdamStep adam) {
  move(node, adam);
  if (kAverages) follow(node, adam);
  if (kFloats) write_floats(model.features, node, changed);
  if (kHalves) write_halves(model.halves, node, changed);
  if (kAverages && kFloats) write_floats(model.averages, node, average);
  if (kAverages && kHalves) write_halves(model.average_halves, node, average);
}

void update_dense(uint node) {
  const uint run = run_of(node);
  sum_gradient(run, run == kNone ? run : end_of(run, node));
  if (usable())
    update(node, adam_step_of_network());
  else
    atomicAdd(batch.statistics.at[kSkipped], 1u);
}

void update_touched(uint run) {
  const uint node = node_at(run), end = end_of(run, node);
  sum_gradient(run, end);
  if (!usable()) {
    atomicAdd(batch.statistics.at[kSkipped], 1u);
    return;
  }
  Words steps = part_of(model.node_steps, node);
  const uint at = place_in_part(model.node_steps, node);
  uint t = steps.at[at];
  if (kPerTriangle)
    t = triangle_step(run, end);
  else if (t != 0xffffffffu)
    ++t;
  steps.at[at] = t;
  update(node, adam_step(t));
}

// Updates the nodes of the runs that begin in a window of kThreads references. The runs are listed first, so
// that they fill few warps. Their order in the list has no effect.
void update_window(uint first) {
  if (gl_LocalInvocationIndex == 0u) run_count = 0u;
  barrier();
  const uint i = first + gl_LocalInvocationIndex;
  if (begins_run(i)) runs[atomicAdd(run_count, 1u)] = i;
  barrier();
  if (gl_LocalInvocationIndex < run_count) update_touched(runs[gl_LocalInvocationIndex]);
  barrier();
}

void main() {
  if (batch.statistics.at[kAccepted] == 0u) return;
  const uint threads = gl_NumWorkGroups.x * gl_NumWorkGroups.y * kThreads;
  if (kDense)
    for (uint node = flat_thread(); node < model.node_count; node += threads) update_dense(node);
  else
    for (uint first = flat_group() * kThreads; first < batch.references; first += threads) update_window(first);
}
