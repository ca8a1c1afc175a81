// SPDX-License-Identifier: BSD-3-Clause
// Opens a comedi board and says what it meets in so many ticks under constant volts; with a signal,
// it ends by that, under a guardian. Linked as the station's plugin is, against libcomedi alone.
#include <yaml-cpp/yaml.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>

#include "ergotic/tgr/safety/guardian.hpp"
#include "tgr/drivers/comedi/comedi_factory.hpp"

int main(int argc, char** argv) {
  using namespace ergotic;
  if (argc < 4 || argc > 5) {
    std::fprintf(stderr, "usage: comedi_probe SETTINGS VOLTS TICKS [SIGNAL]\n");
    return 2;
  }
  try {
    const auto driver = tgr::ComediFactory().make(YAML::Load(argv[1]), "argument");
    driver->open(1000.0);
    std::optional<tgr::Guardian> guardian;
    if (argc == 5) {
      guardian.emplace(driver->guards(), tgr::GuardianOptions{0.04, 0});
    }
    std::array<double, tgr::kMaxSlices> outputs{};
    std::array<double, tgr::kMaxSlices> inputs{};
    outputs.fill(std::atof(argv[2]));
    for (int tick = 0; tick < std::atoi(argv[3]); ++tick) {
      const unsigned flags = driver->exchange(outputs.data(), inputs.data());
      std::printf("%u %.17g\n", flags, inputs[0]);
      if (guardian) {
        guardian->beat();
      }
    }
    std::fflush(stdout);
    if (guardian) {
      std::raise(std::atoi(argv[4]));
    }
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s\n", problem.what());
    return 1;
  }
  return 0;
}
