// Sorted references are divided into runs, where the node changes, and into pieces, also at multiples of
// kPiece. Many threads can then sum a run that many records share. A run or piece has the number of its first
// reference. Push::argument is the array with the sorted references.

const uint kPiece = 64;

uint node_at(uint i) {
  return batch.sorted[argument].at[i].x;
}

bool begins_run(uint i) {
  if (i >= batch.references || node_at(i) >= model.node_count) return false;
  return i == 0u || node_at(i - 1u) != node_at(i);
}

uint next_piece(uint i) {
  return (i / kPiece + 1u) * kPiece;
}

// The first reference at or behind `low` to this node or a later one.
uint first_from(uint low, uint node) {
  uint high = batch.references;
  while (low < high) {
    const uint middle = low + (high - low) / 2u;
    if (node_at(middle) < node)
      low = middle + 1u;
    else
      high = middle;
  }
  return low;
}
