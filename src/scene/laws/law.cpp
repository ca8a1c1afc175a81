// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/law.hpp"

#include "scene/laws/relaxing.hpp"

namespace ergotic::scene {

const Law& lawOf(LiaType type) {
#define ERGOTIC_ADDRESS(name) &k##name##Law,
  static constexpr const Law* kLaws[] = {ERGOTIC_LAWS(ERGOTIC_ADDRESS)};
#undef ERGOTIC_ADDRESS
  return *kLaws[static_cast<std::size_t>(type)];
}

const Value& memberOf(const Lia& lia, LiaMember member) {
  const auto* const own = std::get_if<Value Lia::*>(&member);
  return own != nullptr ? lia.*(*own) : (*lia.law).*(std::get<Value LiaLaw::*>(member));
}

void setMember(Lia& lia, LiaMember member, const Value& value) {
  const auto* const own = std::get_if<Value Lia::*>(&member);
  (own != nullptr ? lia.*(*own) : lia.law.edit().*(std::get<Value LiaLaw::*>(member))) = value;
}

Slopes slopesInSteps(const Scene& scene, const Lia& lia, double step) {
  return lawOf(lia.type).kind == Law::Kind::kRelaxing ? relaxingSlopes(scene, lia, step)
                                                      : slopesOf(scene, lia);
}

Slopes slopesAt(const Scene& scene, const Lia& lia, double elongation) {
  const Law& law = lawOf(lia.type);
  return law.growth == nullptr ? law.slopes(scene, lia)
                               : law.growth->slopes(scene, lia, elongation);
}

}  // namespace ergotic::scene
