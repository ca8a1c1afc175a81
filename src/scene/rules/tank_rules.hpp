// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "scene/rules/fault.hpp"

namespace ergotic::scene {

/// The first tank, or link of one, that breaks a rule. \pre all ends of links exist
std::optional<Fault> wrongTank(const Scene& scene);

}  // namespace ergotic::scene
