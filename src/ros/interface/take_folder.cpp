// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/take_folder.hpp"

#include <algorithm>
#include <filesystem>

#include <sys/stat.h>

#include "ergotic/exception.hpp"
#include "ros/interface/file_name.hpp"

namespace ergotic::node {
namespace {

namespace fs = std::filesystem;

const char kBagEnding[] = ".bag";
const char kUnfinished[] = ".active";
const char kTrash[] = "trash";
constexpr char kStar = '+';

std::int64_t writtenNs(const std::string& path) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  struct stat found {};
  return stat(path.c_str(), &found) == 0 ? found.st_mtim.tv_sec * kSecond + found.st_mtim.tv_nsec
                                         : 0;
}

std::string moved(const std::string& from, const std::string& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) {
    throw Exception(from + ": cannot become " + to + ": " + error.message());
  }
  return to;
}

bool isThere(const std::string& path) {
  std::error_code error;
  return fs::exists(path, error);
}

}  // namespace

std::string TakeFolder::pathOf(const std::string& name, bool is_starred) const {
  return path_ + "/" + name + (is_starred ? std::string(1, kStar) : "") + kBagEnding;
}

std::vector<TakeFile> TakeFolder::list() const {
  std::vector<TakeFile> takes;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(path_, error)) {
    std::error_code unknown;
    if (entry.path().extension() != kBagEnding || !entry.is_regular_file(unknown)) {
      continue;
    }
    TakeFile take;
    take.path = entry.path().string();
    take.name = entry.path().stem().string();
    take.is_starred = take.name.size() > 1 && take.name.back() == kStar;
    take.name.resize(take.name.size() - (take.is_starred ? 1 : 0));
    take.written_ns = writtenNs(take.path);
    takes.push_back(std::move(take));
  }
  std::sort(takes.begin(), takes.end(), [](const TakeFile& a, const TakeFile& b) {
    return a.written_ns != b.written_ns ? a.written_ns > b.written_ns : a.name > b.name;
  });
  takes.resize(std::min(takes.size(), kMaxTakes));
  return takes;
}

TakeFile TakeFolder::find(const std::string& name) const {
  requireFileName("take", name);
  for (const bool is_starred : {false, true}) {
    const std::string path = pathOf(name, is_starred);
    if (isThere(path)) {
      return {name, path, is_starred, writtenNs(path)};
    }
  }
  throw Exception(pathOf(name, false) + ": there is no such take");
}

std::string TakeFolder::placeFor(const std::string& name) const {
  requireFileName("take", name);
  std::error_code error;
  fs::create_directories(path_, error);  // opening what is in it says what is wrong
  for (const bool is_starred : {false, true}) {
    if (isThere(pathOf(name, is_starred))) {
      throw Exception(pathOf(name, is_starred) + " is there already: choose another name");
    }
  }
  return pathOf(name, false);
}

std::string TakeFolder::rename(const std::string& name, const std::string& new_name) const {
  const TakeFile take = find(name);
  const std::string place = placeFor(new_name);
  if (isThere(place + kUnfinished)) {
    throw Exception(place + kUnfinished + " is being recorded: choose another name");
  }
  return moved(take.path, pathOf(new_name, take.is_starred));
}

std::string TakeFolder::star(const std::string& name, bool is_starred) const {
  const TakeFile take = find(name);
  return take.is_starred == is_starred ? take.path : moved(take.path, pathOf(name, is_starred));
}

std::string TakeFolder::discard(const std::string& name) const {
  const TakeFile take = find(name);
  const TakeFolder trash(path_ + "/" + kTrash);
  std::error_code error;
  fs::create_directories(trash.path_, error);
  std::string free = name;
  for (int i = 2; isThere(trash.pathOf(free, false)) || isThere(trash.pathOf(free, true)); ++i) {
    free = name + "_" + std::to_string(i);
  }
  return moved(take.path, trash.pathOf(free, take.is_starred));
}

}  // namespace ergotic::node
