// SPDX-License-Identifier: BSD-3-Clause
#include "lab/lib/bench_report.hpp"

#include <cstdio>
#include <thread>

#include "ergotic/rt/build_id.hpp"
#include "tools/lib/machine.hpp"
#include "tools/lib/options.hpp"

namespace ergotic::tools {
namespace {

#if defined(__clang__)
constexpr const char* kCompiler = "clang " __VERSION__;
#else
constexpr const char* kCompiler = "gcc " __VERSION__;
#endif

double realTimeFactor(double frame_ns) {
  return 1e9 / (frame_ns * benchRates().audio_hz);
}

double nsPerModule(double frame_ns, const BenchResult& result) {
  return frame_ns / static_cast<double>(result.modules);
}

/// Median, and all runs in brackets.
std::string runsText(const std::vector<double>& ns) {
  if (ns.empty()) {
    return "-";
  }
  char text[32];
  std::snprintf(text, sizeof text, "%.0f (", median(ns));
  std::string all = text;
  for (std::size_t i = 0; i < ns.size(); ++i) {
    std::snprintf(text, sizeof text, "%s%.0f", i == 0 ? "" : " ", ns[i]);
    all += text;
  }
  return all + ")";
}

Json machineReport(const MachineLimits& limits) {
  Json levels = Json::array();
  for (const MemoryLevel& level : limits.levels) {
    levels.push_back({{"name", level.name},
                      {"bytes", level.bytes},
                      {"probed_bytes", level.probed},
                      {"gb_per_s", level.gb_per_s}});
  }
  return {{"processor", processorName()},
          {"cores", std::thread::hardware_concurrency()},
          {"levels", std::move(levels)},
          {"gflops", limits.gflops}};
}

Json buildReport() {
  return {{"compiler", kCompiler}, {"flags", ERGOTIC_FLAGS}, {"build_id", rt::buildId()}};
}

Json benchSettings(const BenchSettings& settings) {
  return {{"precision", physics::nameOf(settings.compile.precision)},
          {"isa", rt::nameOf(settings.compile.isa)},
          {"threads", settings.compile.threads},
          {"metered", settings.compile.metered ? 1 : 0},
          {"clock", settings.compile.threads > 1 ? "monotonic" : "thread CPU time"},
          {"runs", settings.runs},
          {"seconds", settings.seconds},
          {"rate_hz", benchRates().audio_hz},
          {"frames_per_tick", benchRates().ratio}};
}

Json resultReport(const BenchResult& result, const MachineLimits& limits) {
  const double ns = median(result.ns);
  const double limit = result.work.limitNs(limits);
  Json report = {{"scene", result.scene},
                 {"modules", result.modules},
                 {"masses", result.masses},
                 {"links", result.links},
                 {"make_s", result.make_s},
                 {"compile_s", result.compile_s},
                 {"ns_per_frame", ns},
                 {"ns_per_frame_runs", result.ns},
                 {"ns_per_module", nsPerModule(ns, result)},
                 {"real_time_factor", realTimeFactor(ns)}};
  if (!result.plain_ns.empty()) {
    const double plain = median(result.plain_ns);
    report["plain_ns_per_frame"] = plain;
    report["plain_ns_per_frame_runs"] = result.plain_ns;
    report["plain_ns_per_module"] = nsPerModule(plain, result);
    report["ratio_to_plain"] = ratioOf(result);
  }
  report["resident_bytes"] = result.work.resident;
  report["level"] = limits.levelFor(result.work.resident).name;
  report["bytes_per_frame"] = result.work.bytes;
  report["operations_per_frame"] = result.work.operations;
  report["limit_ns_per_frame"] = limit;
  report["share_of_limit"] = limit / ns;
  report["chosen"] = result.chosen;
  return report;
}

}  // namespace

void printHead(const BenchSettings& settings, const MachineLimits& limits) {
  std::printf("%s, %s, %s\n", processorName().c_str(), toString(settings.compile).c_str(),
              settings.compile.metered ? "metered" : "not metered");
  std::printf("at most: %.0f G operations/s", limits.gflops);
  for (const MemoryLevel& level : limits.levels) {
    std::printf(", %s %.0f GB/s", level.name.c_str(), level.gb_per_s);
  }
  std::printf(
      "\n\n| scene | modules | ns/frame (runs) | plain ns/frame (runs) | ns/module | plain "
      "ns/module | times real time | plain / ours | of the limit | compile s |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  std::fflush(stdout);
}

void printRow(const BenchResult& result, const MachineLimits& limits) {
  const double ns = median(result.ns);
  std::printf("| %s | %zu | %s | %s | %.3f |", result.scene.c_str(), result.modules,
              runsText(result.ns).c_str(), runsText(result.plain_ns).c_str(),
              nsPerModule(ns, result));
  if (result.plain_ns.empty()) {
    std::printf(" - | %.3g | - |", realTimeFactor(ns));
  } else {
    std::printf(" %.3f | %.3g | %.2f |", nsPerModule(median(result.plain_ns), result),
                realTimeFactor(ns), ratioOf(result));
  }
  std::printf(" %.0f %% | %.2f |\n", 100.0 * result.work.limitNs(limits) / ns, result.compile_s);
  std::fflush(stdout);
}

Json reportOf(const BenchSettings& settings,
              const MachineLimits& limits,
              const std::vector<BenchResult>& results) {
  Json list = Json::array();
  for (const BenchResult& result : results) {
    list.push_back(resultReport(result, limits));
  }
  return {{"machine", machineReport(limits)},
          {"build", buildReport()},
          {"settings", benchSettings(settings)},
          {"results", std::move(list)}};
}

}  // namespace ergotic::tools
