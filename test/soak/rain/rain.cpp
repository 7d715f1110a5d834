// Rain of balls on files: a row for each with the counts of its load report and the outcome, as JSON.
#include <sys/resource.h>

#include <cstdio>
#include <exception>

#include "support/rain/rain.h"

namespace blem_sim {
namespace {

double processorSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

std::string reportOf(const geometry::MeshReport& r) {
  const Vector3 &low = r.extents.min(), &high = r.extents.max();
  return fmt::format(
      R"("triangles": {}, "points": {}, "vertices": {}, "degenerate": {}, "duplicate": {}, "nonfinite": {}, "invalid": {}, "welded": {}, )"
      R"("open_edges": {}, "extents": [{}, {}, {}, {}, {}, {}])",
      r.triangles, r.points, r.vertices, r.degenerate, r.duplicate, r.nonfinite, r.invalid, r.welded, r.open_edges, low.x(), low.y(),
      low.z(), high.x(), high.y(), high.z());
}

std::string outcomeOf(const RainOutcome& o) {
  return fmt::format(
      R"("balls": {}, "touched": {}, "crossed": {}, "untold": {}, "finite": {}, "unreliable_steps": {}, "troubled_steps": {}, )"
      R"("gained_steps": {}, "max_of_layer": {:.4g}, "fastest": {:.4g}, "first_crossing": "{}")",
      o.balls, o.touched, o.crossed, o.untold, o.finite, o.unreliable_steps, o.troubled_steps, o.gained_steps, o.max_of_layer, o.fastest,
      o.first_crossing);
}

std::string quoted(const std::string& text) {
  std::string out;
  for (char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string rowOf(const std::string& file, double seconds) {
  try {
    const double begun = processorSeconds();
    const geometry::MeshReport report = model::loadSurface(file, Vector3::Ones(), {}, model::Mending::OFF).report;
    const std::string outcome = seconds > 0 ? ", " + outcomeOf(rainOn(file, seconds, 1)) : "";
    return fmt::format(R"({}{}, "processor_s": {:.2f})", reportOf(report), outcome, processorSeconds() - begun);
  } catch (const InputError& error) {
    return fmt::format(R"("refused": "{}")", quoted(error.what()));
  }
}

}  // namespace
}  // namespace blem_sim

/** Usage: soak_rain SECONDS FILE ... */
int main(int argc, char** argv) {
  if (argc < 3) return std::fprintf(stderr, "usage: soak_rain SECONDS FILE ...\n"), 2;
  for (int i = 2; i < argc; ++i) {
    std::printf("{\"file\": \"%s\", %s}\n", blem_sim::quoted(argv[i]).c_str(), blem_sim::rowOf(argv[i], std::atof(argv[1])).c_str());
    std::fflush(stdout);
  }
  return 0;
}
