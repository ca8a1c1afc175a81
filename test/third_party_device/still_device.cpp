// SPDX-License-Identifier: BSD-3-Clause
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <atomic>

#include <pluginlib/class_list_macros.hpp>

#include "ergotic/exception.hpp"
#include "ergotic/tgr/driver.hpp"

namespace third_party {

/// Two slices that stand 1 mm, or `height` m, above their rest, whatever pulls at them.
class StillDevice : public ergotic::tgr::Driver {
 public:
  explicit StillDevice(double height) : height_(height) {}

  void open(double /*tick_rate_hz*/) override {}
  void close() noexcept override {}
  int slices() const noexcept override { return 2; }
  std::uint32_t exchange(const double* /*forces*/, double* positions) noexcept override {
    std::fill_n(positions, slices(), height_);
    return made_safe_ ? ergotic::tgr::kMadeSafe : ergotic::tgr::kExchangeOk;
  }
  void makeSafe() noexcept override { made_safe_ = true; }
  void rearm() noexcept override { made_safe_ = false; }

 private:
  double height_;
  std::atomic<bool> made_safe_{false};
};

class StillFactory : public ergotic::tgr::DriverFactory {
 public:
  std::unique_ptr<ergotic::tgr::Driver> make(const YAML::Node& settings,
                                             const std::string& place) const override {
    const double height = settings["height"].as<double>(0.001);
    if (!(height >= 0.0 && height <= 0.01)) {
      throw ergotic::Exception(place + ": error: height is " + std::to_string(height) +
                               " m, allowed: 0...0.01");
    }
    return std::make_unique<StillDevice>(height);
  }
};

}  // namespace third_party

PLUGINLIB_EXPORT_CLASS(third_party::StillFactory, ergotic::tgr::DriverFactory)
