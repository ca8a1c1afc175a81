// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/bench_report.hpp"

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

Report numbers(const std::vector<double>& values) {
  Report list = Report::list();
  for (const double value : values) {
    list.add(Report::number(value));
  }
  return list;
}

Report machineReport(const MachineLimits& limits) {
  Report levels = Report::list();
  for (const MemoryLevel& level : limits.levels) {
    levels.add(Report::map()
                   .add("name", Report::text(level.name))
                   .add("bytes", Report::number(level.bytes))
                   .add("probed_bytes", Report::number(level.probed))
                   .add("gb_per_s", Report::number(level.gb_per_s)));
  }
  return Report::map()
      .add("processor", Report::text(processorName()))
      .add("cores", Report::number(std::thread::hardware_concurrency()))
      .add("levels", std::move(levels))
      .add("gflops", Report::number(limits.gflops));
}

Report buildReport() {
  return Report::map()
      .add("compiler", Report::text(kCompiler))
      .add("flags", Report::text(ERGOTIC_FLAGS))
      .add("build_id", Report::text(rt::buildId()));
}

Report settingsReport(const BenchSettings& settings) {
  return Report::map()
      .add("precision", Report::text(physics::nameOf(settings.compile.precision)))
      .add("isa", Report::text(rt::nameOf(settings.compile.isa)))
      .add("threads", Report::number(settings.compile.threads))
      .add("metered", Report::number(settings.compile.metered ? 1 : 0))
      .add("clock", Report::text(settings.compile.threads > 1 ? "monotonic" : "thread CPU time"))
      .add("runs", Report::number(settings.runs))
      .add("seconds", Report::number(settings.seconds))
      .add("rate_hz", Report::number(benchRates().audio_hz))
      .add("frames_per_tick", Report::number(benchRates().ratio));
}

Report resultReport(const BenchResult& result, const MachineLimits& limits) {
  const double ns = median(result.ns);
  const double limit = result.work.limitNs(limits);
  Report report = Report::map();
  report.add("scene", Report::text(result.scene))
      .add("modules", Report::number(result.modules))
      .add("masses", Report::number(result.masses))
      .add("links", Report::number(result.links))
      .add("make_s", Report::number(result.make_s))
      .add("compile_s", Report::number(result.compile_s))
      .add("ns_per_frame", Report::number(ns))
      .add("ns_per_frame_runs", numbers(result.ns))
      .add("ns_per_module", Report::number(nsPerModule(ns, result)))
      .add("real_time_factor", Report::number(realTimeFactor(ns)));
  if (!result.plain_ns.empty()) {
    const double plain = median(result.plain_ns);
    report.add("plain_ns_per_frame", Report::number(plain))
        .add("plain_ns_per_frame_runs", numbers(result.plain_ns))
        .add("plain_ns_per_module", Report::number(nsPerModule(plain, result)))
        .add("ratio_to_plain", Report::number(ratioOf(result)));
  }
  report.add("resident_bytes", Report::number(result.work.resident))
      .add("level", Report::text(limits.levelFor(result.work.resident).name))
      .add("bytes_per_frame", Report::number(result.work.bytes))
      .add("operations_per_frame", Report::number(result.work.operations))
      .add("limit_ns_per_frame", Report::number(limit))
      .add("share_of_limit", Report::number(limit / ns));
  Report chosen = Report::list();
  for (const std::string& line : result.chosen) {
    chosen.add(Report::text(line));
  }
  return report.add("chosen", std::move(chosen));
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

Report reportOf(const BenchSettings& settings,
                const MachineLimits& limits,
                const std::vector<BenchResult>& results) {
  Report list = Report::list();
  for (const BenchResult& result : results) {
    list.add(resultReport(result, limits));
  }
  return Report::map()
      .add("machine", machineReport(limits))
      .add("build", buildReport())
      .add("settings", settingsReport(settings))
      .add("results", std::move(list));
}

}  // namespace ergotic::tools
