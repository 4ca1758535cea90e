// A stable sort of references by node, four bits of it at a time. A block of references belongs to a workgroup,
// sixteen in a row to a thread. Push::argument: the lowest of the four bits.

const uint kEach = 16;
const uint kBlock = kThreads * kEach;
const uint kDigits = 16;

uint digit_of(uint key) {
  return key >> argument & (kDigits - 1u);
}

// Which of the two arrays is read in this pass.
uint from_array() {
  return argument / 4u % 2u;
}
