// The data of a model and of a batch, and how shaders access it.
#ifndef GATELIGHT_BLOCKS
#define GATELIGHT_BLOCKS
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_control_flow_attributes : require

// The workgroup size that every Vulkan 1.2 device supports.
const uint kThreads = 128;
layout(local_size_x = kThreads) in;

layout(buffer_reference, std430, buffer_reference_align = 4) buffer Floats { float at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) buffer Words { uint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 8) buffer Pairs { uvec2 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Vectors { vec4 at[]; };
// Only existing parts are accessed; an array without a length would need a descriptor feature.
layout(buffer_reference, std430, buffer_reference_align = 8) buffer Parts { Words part[65536]; };

struct HashLevel {  // HashGridLevel
  float scale;
  uint resolution;
  uint entries;
  uint first_node;
  uint dense;
};

#define GATELIGHT_BLOCK(name) layout(buffer_reference, std430, buffer_reference_align = 16) buffer name
#include "block_fields.glsl"

layout(push_constant) uniform Push {
  Model model;
  Batch batch;
  uint argument;
  uint other;
};

// Values of Batch::status.
const uint kStatusAccepted = 0;
const uint kStatusRejected = 1;
const uint kStatusUnstored = 2;

// Dispatches of more than 65535 workgroups have a second dimension.
uint flat_group() {
  return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

uint flat_thread() {
  return flat_group() * kThreads + gl_LocalInvocationIndex;
}

// Tests bits, because compilers may assume that nothing is NaN.
bool finite(float x) {
  return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u;
}

Words part_of(Table table, uint entry) {
  return table.parts.part[entry >> table.shift];
}

uint place_in_part(Table table, uint entry) {
  return (entry & ((1u << table.shift) - 1u)) * table.stride;
}

#endif
