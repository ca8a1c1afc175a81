// SPDX-License-Identifier: BSD-3-Clause
// What tests of proofs share.
#pragma once

#include <cstdlib>
#include <fstream>
#include <string>

#include <sys/wait.h>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/places.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"
#include "support/tool_process.hpp"
#include "tools/lib/proof_file.hpp"

namespace ergotic {

using test::ScratchFile;

/// Of a script of this repository.
inline int python(const std::string& command) {
  const int status = std::system(("/usr/bin/python3 " + repository("") + command).c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// A scene of the brief language as it is played, written to `path`. \return its file
inline std::string writtenOut(const std::string& model, const std::string& path) {
  const std::string ending = ".yaml";
  if (model.size() < ending.size() ||
      model.compare(model.size() - ending.size(), ending.size(), ending) != 0) {
    return model;
  }
  const test::Outcome written = test::run("expand", model, "/dev/null");
  EXPECT_EQ(written.code, 0) << model;
  std::ofstream(path) << written.text;
  return path;
}

/// What scripts/check_proof says of the proof of `other`, whole, under the name of `text`.
inline std::string refusalUnderTheNameOf(const std::string& text, const std::string& other) {
  const ScratchFile scene_file(text);
  const ScratchFile file;
  const ScratchFile said;
  scene::Scene scene = scene::readYaml(other, scene_file.path());
  const physics::Rates rates = physics::chooseRates(scene, 44100.0, 0.0);
  scene = physics::settle(std::move(scene), rates).scene;
  physics::Proof proof;
  const physics::Verdict found = physics::certify(scene, rates, {}, &proof).verdict;
  EXPECT_LE(found, physics::Verdict::kBounded) << other;
  tools::writeProof(file.path(), scene, rates, found, proof);
  const int code =
      python("scripts/check_proof " + file.path() + " " + scene_file.path() + " 2> " + said.path());
  EXPECT_EQ(code, said.text().empty() ? 0 : 1);
  return said.text();
}

}  // namespace ergotic
