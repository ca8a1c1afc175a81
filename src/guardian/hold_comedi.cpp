// SPDX-License-Identifier: BSD-3-Clause
#include <comedi.h>

#include <sys/ioctl.h>

#include "guardian/hold.hpp"

namespace ergotic::guardian {
namespace {

unsigned number(const std::string& word) {
  return static_cast<unsigned>(std::stoul(word));
}

class ComediHold final : public Hold {
 public:
  ComediHold(const std::vector<std::string>& words, int file)
      : file_(file), counts_(words.size() / 3), insns_(counts_.size()) {
    for (std::size_t i = 0; i < insns_.size(); ++i) {
      counts_[i] = number(words[3 * i + 2]);
      insns_[i].insn = INSN_WRITE;
      insns_[i].n = 1;
      insns_[i].data = &counts_[i];
      insns_[i].subdev = number(words[3 * i]);
      insns_[i].chanspec = number(words[3 * i + 1]);
    }
  }

  void makeSafe() noexcept override {
    comedi_insnlist list{static_cast<unsigned>(insns_.size()), insns_.data()};
    ::ioctl(file_, COMEDI_INSNLIST, &list);
  }

 private:
  int file_;
  std::vector<lsampl_t> counts_;
  std::vector<comedi_insn> insns_;
};

}  // namespace

std::unique_ptr<Hold> holdComedi(const std::vector<std::string>& words, int file) {
  return std::make_unique<ComediHold>(words, file);
}

}  // namespace ergotic::guardian
