// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/rt/build_id.hpp"

#include <elf.h>
#include <link.h>

#include <cstdint>
#include <cstring>

namespace ergotic::rt {
namespace {

constexpr std::size_t kNoteAlignment = 4;

struct Search {
  std::uintptr_t address = 0;  // inside the object that is looked for
  std::string hash;
};

std::string hexadecimal(const unsigned char* bytes, std::size_t count) {
  static const char kDigits[] = "0123456789abcdef";
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text += kDigits[bytes[i] >> 4U];
    text += kDigits[bytes[i] & 15U];
  }
  return text;
}

std::size_t padded(std::size_t size) {
  return (size + kNoteAlignment - 1) / kNoteAlignment * kNoteAlignment;
}

/// The build id among the notes of one segment; empty if it is not there.
std::string hashAmong(const unsigned char* notes, std::size_t size) {
  ElfW(Nhdr) note;
  for (std::size_t at = 0; at + sizeof note <= size;) {
    std::memcpy(&note, notes + at, sizeof note);
    const unsigned char* content = notes + at + sizeof note + padded(note.n_namesz);
    if (note.n_type == NT_GNU_BUILD_ID) {
      return hexadecimal(content, note.n_descsz);
    }
    at += sizeof note + padded(note.n_namesz) + padded(note.n_descsz);
  }
  return "";
}

int visitObject(dl_phdr_info* object, std::size_t /*size*/, void* data) {
  auto& search = *static_cast<Search*>(data);
  bool is_ours = false;
  std::string hash;
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[i];
    const std::uintptr_t start = object->dlpi_addr + segment.p_vaddr;
    if (segment.p_type == PT_LOAD) {
      is_ours |= search.address - start < segment.p_memsz;
    } else if (segment.p_type == PT_NOTE && hash.empty()) {
      // NOLINTNEXTLINE(performance-no-int-to-ptr): this is what the loader tells us.
      hash = hashAmong(reinterpret_cast<const unsigned char*>(start), segment.p_memsz);
    }
  }
  if (is_ours) {
    search.hash = hash;
  }
  return is_ours ? 1 : 0;
}

}  // namespace

std::string buildId() {
  Search search;
  search.address = reinterpret_cast<std::uintptr_t>(&buildId);
  dl_iterate_phdr(&visitObject, &search);
  return search.hash;
}

}  // namespace ergotic::rt
