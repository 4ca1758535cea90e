// A prefix sum over a workgroup, in steps of doubled distance.

shared uint scan_words[kThreads];

// Returns the sum over the threads before this one; `total` is the sum over all. Every thread must call it.
uint sum_before(uint value, out uint total) {
  const uint t = gl_LocalInvocationIndex;
  scan_words[t] = value;
  barrier();
  for (uint distance = 1u; distance < kThreads; distance *= 2u) {
    const uint lower = t >= distance ? scan_words[t - distance] : 0u;
    barrier();
    scan_words[t] += lower;
    barrier();
  }
  total = scan_words[kThreads - 1u];
  const uint result = scan_words[t] - value;
  barrier();
  return result;
}
