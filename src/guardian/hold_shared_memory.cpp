// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/exception.hpp"
#include "guardian/hold.hpp"
#include "tgr/drivers/virtual/shared_device.hpp"

namespace ergotic::guardian {
namespace {

class SharedMemoryHold final : public Hold {
 public:
  SharedMemoryHold(const std::string& name, std::int64_t born_ns)
      : segment_(tgr::SharedSegment::attach(name)), session_(segment_->session) {
    if (segment_->born_ns != born_ns) {
      throw DeviceError("virtual device " + name + ": it is another one by now");
    }
  }

  void makeSafe() noexcept override {
    if (segment_->session == session_) {  // else it is another driver's by now
      segment_->safe = 1;
    }
  }

 private:
  tgr::SharedSegment segment_;
  std::uint32_t session_;
};

}  // namespace

std::unique_ptr<Hold> holdSharedMemory(const std::vector<std::string>& words) {
  return std::make_unique<SharedMemoryHold>(words.at(0), std::stoll(words.at(1)));
}

}  // namespace ergotic::guardian
