// The data of a model and of a batch, in std430 layout. Shaders and blocks.h include this file; C++ has the
// same layout for numbers and addresses. Address 0 means that the array does not exist.

// An array of entries of `stride` words, divided into parts of 2^shift entries.
struct Table {
  Parts parts;
  uint shift;
  uint stride;
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

GATELIGHT_BLOCK(Model) {
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
  uint sources;  // bit s is set if source s of the batch is read; see kBarycentricsSource
  uint auxiliary_count;
  float inverse_extent;
  float max_target;
  float bounds_min[3];
  HashLevel hash_levels[16];
  Auxiliary auxiliary[16];
  Adam adam;
};

GATELIGHT_BLOCK(Batch) {
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
  Words keys;       // nodes, [record][slot]
  Pairs sorted[2];  // node and number of each reference; the sort alternates between the two arrays
  Floats weights;   // [record][slot]
  Floats feature_gradients;  // [record][feature input]
  Floats losses;             // [tile]
  Floats partials;           // [group][network parameter]
  Words counts;              // [row][digit] of the sort
  Floats piece_sums;         // [piece][feature]
  Words piece_steps;
  Words statistics;
  Floats answers;
  Vectors forward;
  uint size;
  uint capacity;
  uint references;
  uint tiles;
  uint groups;
};

// Indices of the words of Batch::statistics.
const uint kAccepted = 0;
const uint kRejected = 1;
const uint kUnstored = 2;
const uint kClipped = 3;
const uint kSkipped = 4;
const uint kTouched = 5;
const uint kLoss = 6;
const uint kStatisticsWords = 7;

// The sort counts references by digit, in one row per block. Sums of rows follow the rows.
const uint kDigits = 256;
const uint kMostBlocks = 512;
const uint kBlocksASum = 16;
const uint kSumsAPass = kMostBlocks / kBlocksASum;
const uint kMostPasses = 4;

// Bits of pack_network's argument.
const uint kPackBackward = 1;
const uint kPackAveraged = 2;
const uint kPackRounded = 4;

// The bit of Model::sources for barycentrics; lower bits are those of InputSource.
const uint kBarycentricsSource = 5;
