#include "times.hpp"

namespace repel::host {

nlohmann::ordered_json percentiles(const DurationHistogram& times) {
  return {{"p50", times.percentile_us(0.5)},
          {"p99", times.percentile_us(0.99)},
          {"p99_9", times.percentile_us(0.999)},
          {"max", times.max_us()}};
}

nlohmann::ordered_json to_json(const Machine& machine) {
  return {{"cpu", machine.cpu},
          {"kernel", machine.kernel},
          {"scheduler", machine.scheduler},
          {"compiler", machine.compiler},
          {"commit", machine.commit}};
}

void print_times(const char* name, const DurationHistogram& times, std::FILE* out) {
  std::fprintf(out, "  %-22s p50 %8.2f   p99 %8.2f   p99.9 %8.2f   max %9.2f us\n", name,
               times.percentile_us(0.5), times.percentile_us(0.99), times.percentile_us(0.999),
               times.max_us());
}

void print_machine(const Machine& machine, std::FILE* out) {
  std::fprintf(out, "  machine                %s, %s\n                         %s, %s, commit %s\n",
               machine.cpu.c_str(), machine.kernel.c_str(), machine.scheduler.c_str(),
               machine.compiler.c_str(), machine.commit.c_str());
}

}  // namespace repel::host
