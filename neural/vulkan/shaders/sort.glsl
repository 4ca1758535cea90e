// A stable radix sort of references by node, four bits per pass. A workgroup has a block of references, a
// thread has sixteen consecutive ones. Push::argument is the lowest of the four bits.

const uint kEach = 16;
const uint kBlock = kThreads * kEach;
const uint kDigits = 16;

uint digit_of(uint key) {
  return key >> argument & (kDigits - 1u);
}

// The array that this pass reads.
uint from_array() {
  return argument / 4u % 2u;
}
