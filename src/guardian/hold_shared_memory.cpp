// SPDX-License-Identifier: BSD-3-Clause
#include "guardian/hold.hpp"
#include "tgr/drivers/virtual/shared_device.hpp"

namespace ergotic::guardian {
namespace {

class SharedMemoryHold final : public Hold {
 public:
  explicit SharedMemoryHold(const std::string& name)
      : segment_(tgr::SharedSegment::attach(name)), session_(segment_->session) {}

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
  return std::make_unique<SharedMemoryHold>(words.at(0));
}

}  // namespace ergotic::guardian
