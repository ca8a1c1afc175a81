// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <random>
#include <sstream>
#include <utility>

#include "support/small_scene.hpp"

namespace ergotic::test {
namespace {

/// The value of a key in an entry such as `m0: {type: mass, section: all}`.
std::string valueOf(const std::string& entry, const std::string& key) {
  const std::size_t from = entry.find(key + ": ") + key.size() + 2;
  return entry.substr(from, entry.find_first_of(",}", from) - from);
}

class Tapper {
 public:
  Tapper(SmallScene scene, unsigned seed) : scene_(std::move(scene)), random_(seed + 1) {}

  SmallScene run() {
    for (std::string& lia : scene_.lias) {
      if (liesOnModules(lia)) {
        continue;
      }
      const std::size_t from = lia.find('[') + 1;
      const std::size_t comma = lia.find(", ", from);
      const std::size_t end = lia.find(']', from);
      const std::string a = endAt(lia.substr(from, comma - from));
      const std::string b = endAt(lia.substr(comma + 2, end - comma - 2));
      lia.replace(from, end - from, a + ", " + b);
    }
    return std::move(scene_);
  }

 private:
  /// Bends, what shares a tank, and springs that are stretched.
  bool liesOnModules(const std::string& lia) const {
    const std::string name = lia.substr(0, lia.find(':'));
    const std::string type = valueOf(lia, "type");
    return type == "bend" || type == "stretch" || lia.find(", tank: ") != std::string::npos ||
           isStretched(scene_, name);
  }
  bool chance(double share) { return std::uniform_real_distribution<double>()(random_) < share; }
  double weight() { return std::uniform_real_distribution<double>(-1.5, 1.5)(random_); }

  /// The module, or a tap on it and on others of its section.
  std::string endAt(const std::string& mat) {
    if (mat[0] != 'm' || chance(0.4)) {
      return mat;
    }
    std::string section;
    for (const std::string& entry : scene_.mats) {
      section = entry.rfind(mat + ":", 0) == 0 ? valueOf(entry, "section") : section;
    }
    std::ostringstream of;
    std::ostringstream weights;
    of << mat;
    weights << weight();
    for (const std::string& entry : scene_.mats) {
      const std::string name = entry.substr(0, entry.find(':'));
      if (name != mat && valueOf(entry, "type") != "tap" && valueOf(entry, "section") == section &&
          chance(0.4)) {
        of << ", " << name;
        weights << ", " << weight();
      }
    }
    const std::string tap = "t" + std::to_string(scene_.mats.size());
    scene_.mats.push_back(tap + ": {type: tap, of: [" + of.str() + "], weights: [" + weights.str() +
                          "]}");
    return tap;
  }

  SmallScene scene_;
  std::mt19937 random_;
};

}  // namespace

bool isStretched(const SmallScene& scene, const std::string& link) {
  return std::any_of(scene.lias.begin(), scene.lias.end(), [&](const std::string& lia) {
    const std::size_t from = lia.find(", of: [");
    const std::string of = from == std::string::npos ? "" : lia.substr(from, lia.find(']') - from);
    return of.find("[" + link + ",") != std::string::npos ||
           of.find(" " + link + ",") != std::string::npos ||
           (of.size() > link.size() &&
            of.compare(of.size() - link.size() - 1, std::string::npos, " " + link) == 0) ||
           of == ", of: [" + link;
  });
}

SmallScene withTaps(SmallScene scene, unsigned seed) {
  return Tapper(std::move(scene), seed).run();
}

}  // namespace ergotic::test
