// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "tools/lib/check_report.hpp"

namespace ergotic::tools {
namespace {

constexpr std::size_t kMaxNamed = 8;  // of a list; a scene may have hundreds

std::string digits(double value, int count = 4) {
  std::ostringstream text;
  text.precision(count);
  text << value;
  return text.str();
}

std::string digits(const Json& value) {
  return value.is_number() ? digits(value.get<double>()) : "any";
}

/// The nearest note of equal temperament and how far the pitch is off, as `A2` or `A2 +14 cents`.
std::string noteOf(double hz) {
  constexpr const char* kNames[] = {"C",  "C#", "D",  "D#", "E",  "F",
                                    "F#", "G",  "G#", "A",  "A#", "B"};
  constexpr int kOctave = 12;
  constexpr int kMidiA4 = 69;
  const double semitones = kMidiA4 + kOctave * std::log2(hz / 440.0);
  const long nearest = std::lround(semitones);
  if (nearest < 0) {
    return "below all notes";
  }
  const long cents = std::lround(100.0 * (semitones - static_cast<double>(nearest)));
  std::string text = kNames[nearest % kOctave] + std::to_string(nearest / kOctave - 1);
  if (cents != 0) {
    text += (cents > 0 ? " +" : " ") + std::to_string(cents) + " cents";
  }
  return text;
}

std::string listOf(const Json& items, const std::function<std::string(const Json&)>& said) {
  std::string list;
  for (std::size_t i = 0; i < std::min(items.size(), kMaxNamed); ++i) {
    list += (list.empty() ? "" : ", ") + said(items[i]);
  }
  if (items.size() > kMaxNamed) {
    list += " and " + std::to_string(items.size() - kMaxNamed) + " more";
  }
  return list.empty() ? "none" : list;
}

std::string stabilityIn(const Json& report) {
  const Json& stability = report["stability"];
  const double margin = stability["margin"].get<double>();
  std::string text =
      stability["verdict"].get<std::string>() + "; " + stability["advice"].get<std::string>();
  if (margin > 0.0) {
    text += "; " + std::to_string(std::lround(100.0 * margin)) +
            " % of what the sound rate bears is left";
  }
  return text;
}

std::string partsIn(const Json& report) {
  std::string schemes;
  for (const auto& [scheme, count] : report["links"]["schemes"].items()) {
    schemes += (schemes.empty() ? "" : ", ") + count.dump() + " " + scheme;
  }
  return report["modules"].dump() + " modules, " + report["links"]["count"].dump() + " links" +
         (schemes.empty() ? "" : " (" + schemes + ")");
}

std::string pitchesIn(const Json& report) {
  Json all = report["strings"];
  all.insert(all.end(), report["bodies"].begin(), report["bodies"].end());
  if (all.empty()) {
    return "--modes tells at what it sounds";
  }
  return listOf(all,
                [](const Json& body) {
                  const double hz = body["pitch_hz"].get<double>();
                  return body["name"].get<std::string>() + " " + digits(hz) + " Hz (" + noteOf(hz) +
                         ")";
                }) +
         "; --modes tells all of the scene as a whole";
}

/// Lists the rendered stiffness of each port, and its passivity limit.
std::string handsIn(const Json& report) {
  return listOf(report["ports"], [](const Json& port) {
    const std::string who =
        port.contains("slice") ? "slice " + port["slice"].dump() + " " : std::string();
    return who + port["name"].get<std::string>() + " (up to " + digits(port["stiffness_n_per_m"]) +
           " N/m, bears " + digits(port["passive_up_to_n_per_m"]) + ")";
  });
}

std::string parametersIn(const Json& report) {
  return listOf(report["parameters"], [](const Json& parameter) {
    const auto unit = parameter["unit"].get<std::string>();
    return parameter["name"].get<std::string>() + " " + digits(parameter["value"]) +
           (unit == "not said" ? "" : " " + unit) + " (" + digits(parameter["minimum"]) + "..." +
           digits(parameter["maximum"]) + ")";
  });
}

std::string costIn(const Json& report) {
  const auto precision = report["program"]["precision"].get<std::string>();
  const double factor = report["cost"][precision]["real_time_factor"].get<double>();
  return digits(100.0 / factor, 2) + " % of a core of this machine for the model alone, in " +
         precision + " precision" +
         (report["program"].value("a_body_moves_freely", false) ? ", as a body moves freely" : "");
}

std::vector<std::string> warningsIn(const Json& report) {
  std::vector<std::string> lines;
  for (const Json& list : {report["stability"]["findings"], report["warnings"],
                           report.value("slice_findings", Json::array())}) {
    for (const Json& item : list) {
      const auto line = item.get<std::string>();
      if (std::find(lines.begin(), lines.end(), line) == lines.end()) {
        lines.push_back(line);
      }
    }
  }
  return lines;
}

}  // namespace

void printBrief(const Json& report, std::ostream& out) {
  const std::vector<std::string> warnings = warningsIn(report);
  out << report["scene"].get<std::string>() << "\nstability: " << stabilityIn(report)
      << "\nmade of: " << partsIn(report) << "\npitches: " << pitchesIn(report)
      << "\nhands: " << handsIn(report) << "\noutputs: "
      << listOf(report["outputs"],
                [](const Json& output) {
                  return output["name"].get<std::string>() + " on channel " +
                         output["channel"].dump();
                })
      << "\nparameters: " << parametersIn(report) << "\nrates: sound "
      << digits(report["audio_rate_hz"].get<double>(), 6) << " Hz, hand "
      << digits(report["gestural_rate_hz"].get<double>(), 6) << " Hz\ncost: " << costIn(report)
      << '\n';
  if (report.contains("variants")) {
    out << "variants: " << listOf(report["variants"], [](const Json& variant) {
      return variant["name"].get<std::string>() + " " + variant["verdict"].get<std::string>();
    }) << '\n';
  }
  out << (warnings.empty() ? "warnings: none\n" : "warnings:\n");
  for (const std::string& warning : warnings) {
    out << "  - " << warning << '\n';
  }
  if (!report["notes"].empty()) {
    const std::size_t count = report["notes"].size();
    out << "notes: " << count << (count == 1 ? " choice was" : " choices were")
        << " made for the scene; --verbose tells them\n";
  }
  if (report.contains("target")) {
    printText({{"target", report["target"]}}, out);
  }
}

}  // namespace ergotic::tools
