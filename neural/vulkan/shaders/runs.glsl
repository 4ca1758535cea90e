// Sorted references are divided into runs, where the node changes, and into pieces, also at multiples of
// kPiece. Many threads can then sum a run that many records share. Push::argument is the array that holds the
// sort's result.

const uint kEach = 16;
const uint kBlock = kThreads * kEach;
const uint kPiece = 64;

uint key_at(uint i) {
  return batch.keys[argument].at[i];
}

bool is_reference(uint i) {
  return i < batch.references && key_at(i) < model.node_count;
}

bool begins_run(uint i) {
  return i == 0u || key_at(i - 1u) != key_at(i);
}

// Number of pieces (lower half of the word) and runs (upper half) that begin at reference i.
uint beginnings(uint i) {
  if (!is_reference(i)) return 0u;
  if (begins_run(i)) return 0x10001u;
  return i % kPiece == 0u ? 1u : 0u;
}
