// The data of a model and of a batch. Each field must match blocks.h.
#ifndef GATELIGHT_BLOCKS
#define GATELIGHT_BLOCKS
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_control_flow_attributes : require

// The workgroup size that every Vulkan 1.2 device supports.
const uint kThreads = 128;

layout(buffer_reference, std430, buffer_reference_align = 4) buffer Floats { float at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) buffer Words { uint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Vectors { vec4 at[]; };
// Only existing parts are accessed; an array without a length would need a descriptor feature.
layout(buffer_reference, std430, buffer_reference_align = 8) buffer Parts { Words part[65536]; };

// An array of entries of `stride` words, divided into parts of 2^shift entries.
struct Table {
  Parts parts;
  uint shift;
  uint stride;
};

struct HashLevel {
  float scale;
  uint resolution;
  uint entries;
  uint first_node;
  uint dense;
};

struct Auxiliary {
  uint source;
  uint transform;
  uint coordinates;
  uint size;
  uint first_input;
  uint inputs;
};

struct Adam {
  float beta1;
  float beta2;
  float learning_rate;
  float epsilon;
  float l2_network;
  float decay_steps;
  float log_beta1;
  float log_beta2;
  float least_average_rate;
  float average_ramp;
  uint table_steps;
  uint average_network;
};

layout(buffer_reference, std430, buffer_reference_align = 16) buffer Model {
  Table topology;  // entries of one word
  Table features;
  Table halves;
  Table averages;
  Table average_halves;
  Table moments;
  Table node_steps;
  Table triangle_steps;
  Table triangle_stamps;
  Words surfaces;
  Words levels;
  Floats parameters;
  Floats network_average;
  Floats first_moments;
  Floats second_moments;
  Floats forward;
  Floats backward;
  Vectors adam_table;
  Words progress;  // number of steps, lower word first
  uint surface_count;
  uint level_count;
  uint nodes_per_level;
  uint per_triangle;
  uint node_count;
  uint feature_count;
  uint feature_inputs;
  uint inputs;
  uint outputs;
  uint width;
  uint hidden_layers;
  uint biases;
  uint network_count;
  uint sources;  // bit s is set if source s of the batch is read; bit 5 is for barycentrics
  uint auxiliary_count;
  float inverse_extent;
  float max_target;
  float bounds_min[3];
  HashLevel hash_levels[16];
  Auxiliary auxiliary[16];
  Adam adam;
};

layout(buffer_reference, std430, buffer_reference_align = 16) buffer Batch {
  Table read;  // the features that this batch reads
  Words surfaces;
  Words triangles;
  Floats barycentrics;
  Floats positions;
  Floats directions;
  Floats normals;
  Floats albedos;
  Floats roughnesses;
  Floats targets;
  Floats inputs;  // [input][capacity]
  Words status;
  Words record_triangles;
  Words keys[2];    // nodes, [record][slot]; the sort alternates between the two arrays
  Words values[2];  // numbers of the references
  Floats weights;   // [record][slot]
  Floats feature_gradients;  // [record][feature input]
  Floats losses;             // [tile]
  Floats partials;           // [group][network parameter]
  Words counts;
  Words piece_starts;
  Floats piece_sums;
  Words piece_steps;
  Words nodes;
  Words node_pieces;
  Words statistics;
  Floats answers;
  Vectors forward;
  uint size;
  uint capacity;
  uint references;
  uint tiles;
  uint groups;
  uint blocks;  // number of blocks of references
};

layout(push_constant) uniform Push {
  Model model;
  Batch batch;
  uint argument;
  uint other;
};

// Indices of the words of Batch::statistics.
const uint kAccepted = 0;
const uint kRejected = 1;
const uint kUnstored = 2;
const uint kClipped = 3;
const uint kSkipped = 4;
const uint kPieces = 5;
const uint kTouched = 6;
const uint kLoss = 7;

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
