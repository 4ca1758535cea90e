// The kernels read whole vectors, but nothing beyond the end of a batch: the page there is not accessible.

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <new>

#include "tests/support/parity.h"

namespace gatelight::neural {
namespace {

using namespace testing;

/// A copy of an array that ends where a page without access begins.
template <class T>
class AtTheEdge {
 public:
  explicit AtTheEdge(const std::vector<T>& values) : size_(values.size()) {
    const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    const std::size_t held = (size_ * sizeof(T) + page - 1) / page * page;
    bytes_ = held + page;
    start_ = ::mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (start_ == MAP_FAILED) throw std::bad_alloc();
    char* const end = static_cast<char*>(start_) + held;
    ::mprotect(end, page, PROT_NONE);
    data_ = reinterpret_cast<T*>(end - size_ * sizeof(T));
    if (size_ > 0) std::memcpy(data_, values.data(), size_ * sizeof(T));
  }
  ~AtTheEdge() { ::munmap(start_, bytes_); }
  AtTheEdge(const AtTheEdge&) = delete;
  AtTheEdge& operator=(const AtTheEdge&) = delete;
  std::span<const T> span() const { return {data_, size_}; }

 private:
  std::size_t size_ = 0;
  std::size_t bytes_ = 0;
  void* start_ = nullptr;
  T* data_ = nullptr;
};

struct EdgeBatch {
  explicit EdgeBatch(const OwnedBatch& b)
      : surfaces(b.surfaces),
        triangles(b.triangles),
        barycentrics(b.barycentrics),
        positions(b.positions),
        directions(b.directions),
        normals(b.normals),
        albedos(b.albedos),
        roughnesses(b.roughnesses),
        targets(b.targets),
        size(b.size()) {}
  QueryBatch points() const {
    return {surfaces.span(),  triangles.span(),   barycentrics.span(),
            positions.span(), directions.span(),  normals.span(),
            albedos.span(),   roughnesses.span(), size};
  }

  AtTheEdge<std::uint32_t> surfaces, triangles;
  AtTheEdge<Float2> barycentrics;
  AtTheEdge<Float3> positions, directions, normals, albedos;
  AtTheEdge<float> roughnesses, targets;
  std::size_t size;
};

TEST(KernelReads, NothingIsReadBeyondTheEndOfABatch) {
  for (const char* name : {"nrc", "nao", "gate_with_everything", "hash_F4", "plain_with_everything"}) {
    const ModelCase c = find_model_case(name);
    for (const std::size_t size : {1u, 15u, 16u, 48u, 50u, 96u, 768u}) {
      const OwnedBatch batch = make_batch(*c.model, size, 3);
      const EdgeBatch edge(batch);
      for (const simd::Isa isa : simd::available_isas()) {
        SCOPED_TRACE(fmt::format("{}, {}, {}", name, size, isa_name(isa)));
        const auto one = cpu::make_cpu_backend(c.model, {}, isa);
        const auto other = cpu::make_cpu_backend(c.model, {}, isa);
        one->train(batch.training());
        other->train({edge.points(), edge.targets.span()});
        EXPECT_EQ(one->export_state(), other->export_state());
        for (const QueryPrecision precision : {QueryPrecision::fp32, QueryPrecision::bf16}) {
          std::vector<float> a(size * c.model->config.mlp.outputs);
          std::vector<float> b(a.size());
          one->query(batch.points(), {.precision = precision}, a);
          other->query(edge.points(), {.precision = precision}, b);
          EXPECT_EQ(a, b);
        }
      }
    }
  }
}

}  // namespace
}  // namespace gatelight::neural
