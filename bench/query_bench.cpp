// query/{nrc,nao}/{gate,hashgrid}/{coherent,random}/{fp32,bf16}: the cache's answers for 1920x1080 points on
// one million triangles.

#include "bench/neural_rows.h"

namespace gatelight::bench {
namespace {

struct Answerer {
  NeuralCase which;
  std::shared_ptr<const neural::Model> model;
  std::unique_ptr<neural::Backend> backend;
};

void query(benchmark::State& state, const NeuralCase& which, Order order, neural::QueryPrecision precision) {
  static Answerer answerer;
  all_threads().execute([&] {
    if (answerer.backend == nullptr || answerer.which != which) {
      answerer.backend.reset();
      answerer.which = which;
      answerer.model = neural_model(which);
      answerer.backend = neural::cpu::make_cpu_backend(answerer.model, {});
    }
    const NeuralPoints& points = query_points(order);
    std::vector<float> out(points.size() * answerer.model->config.mlp.outputs);
    neural::QueryOptions options;
    options.precision = precision;
    answerer.backend->query(points.query_batch(), options, out);  // warm up
    for (auto _ : state) answerer.backend->query(points.query_batch(), options, out);
  });
}

const bool query_registered = [] {
  for (const Cache cache : {Cache::nrc, Cache::nao}) {
    for (const Encoding encoding : {Encoding::gate, Encoding::hash_grid}) {
      for (const Order order : {Order::coherent, Order::random}) {
        for (const auto& [word, precision] :
             {std::pair{"fp32", neural::QueryPrecision::fp32}, {"bf16", neural::QueryPrecision::bf16}}) {
          const NeuralCase which{cache, encoding};
          const std::string name = "query/" + case_name(which) + "/" + order_name(order) + "/" + word;
          benchmark::RegisterBenchmark(name.c_str(), query, which, order, precision)
              ->Unit(benchmark::kMillisecond);
        }
      }
    }
  }
  return true;
}();

}  // namespace
}  // namespace gatelight::bench
