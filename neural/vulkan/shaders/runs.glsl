// Sorted references, cut where the node changes (runs) and at multiples of kPiece too (pieces), so that a run
// that many records share is summed by many threads. Push::argument: which array the sort left them in.

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

// Pieces in the lower half of a word, runs in the upper one.
uint beginnings(uint i) {
  if (!is_reference(i)) return 0u;
  if (begins_run(i)) return 0x10001u;
  return i % kPiece == 0u ? 1u : 0u;
}
