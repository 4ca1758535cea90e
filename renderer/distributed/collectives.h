#pragma once
// Collective operations on values: all ranks call the same ones in the same order.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "renderer/distributed/packing.h"
#include "renderer/distributed/ranks.h"

namespace gatelight::renderer {

/// The values of all these bytes, one after the other.
template <class T>
std::vector<T> unpacked_one_after_another(const std::vector<Bytes>& all) {
  std::vector<T> values;
  for (const Bytes& bytes : all) {
    const std::vector<T> of_one = Unpacker(bytes).rest<T>();
    values.insert(values.end(), of_one.begin(), of_one.end());
  }
  return values;
}

/// The values of all ranks, one after the other.
template <class T>
std::vector<T> joined(Ranks& ranks, std::vector<T> mine) {
  if (ranks.is_single()) return mine;
  Packer packer;
  packer.add_all(std::span(mine));
  return unpacked_one_after_another<T>(ranks.gather(packer.take()));
}

/// The same for rank 0; the others get nothing.
template <class T>
std::vector<T> joined_at_first(Ranks& ranks, std::vector<T> mine) {
  if (ranks.is_single()) return mine;
  Packer packer;
  packer.add_all(std::span(mine));
  std::vector<Bytes> outgoing(static_cast<std::size_t>(ranks.count()));
  outgoing[0] = packer.take();
  return unpacked_one_after_another<T>(ranks.exchange(std::move(outgoing)));
}

/// One value of each rank.
template <class T>
std::vector<T> one_of_each(Ranks& ranks, const T& mine) {
  return joined(ranks, std::vector<T>{mine});
}

/// Rank 0's value, broadcast to all.
template <class T>
T agreed(Ranks& ranks, T mine) {
  if (ranks.is_single()) return mine;
  Packer packer;
  packer.add(mine);
  Bytes bytes = packer.take();
  ranks.broadcast(bytes);
  return Unpacker(bytes).read<T>();
}

/// Whether `mine` is true at any rank.
inline bool any(Ranks& ranks, bool mine) {
  for (const std::uint8_t one : one_of_each(ranks, static_cast<std::uint8_t>(mine))) mine |= one != 0;
  return mine;
}

template <class T>
T sum_of_all(Ranks& ranks, const T& mine) {
  T sum{};
  for (const T& one : one_of_each(ranks, mine)) sum += one;
  return sum;
}

}  // namespace gatelight::renderer
