// SPDX-License-Identifier: BSD-3-Clause
#include "physics/modes/modal_cache.hpp"

#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <system_error>

#include <Eigen/Core>

#include "algebra/decompositions.hpp"
#include "ergotic/exception.hpp"

namespace ergotic::physics {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMagic = 0x45444f4d4f475245;  // "ERGOMODE" where bytes go upwards
constexpr std::uint64_t kVersion = 1;
using Key = std::array<std::uint64_t, 2>;

/// FNV-1a over words of 64 bits.
class Hash {
 public:
  explicit Hash(std::uint64_t seed) : value_(0xcbf29ce484222325 ^ seed) {}
  void add(std::uint64_t word) {
    value_ = (value_ ^ word) * 0x100000001b3;
    value_ ^= value_ >> 32U;
  }
  void add(double number) {
    std::uint64_t word = 0;
    std::memcpy(&word, &number, sizeof word);
    add(word);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_;
};

Key keyOf(const ModalMatrix& matrix) {
  Key key{};
  for (std::size_t k = 0; k < key.size(); ++k) {
    Hash hash(k);
    hash.add(kVersion);
    hash.add(static_cast<std::uint64_t>(matrix.size));
    for (const ModalMatrix::Entry& entry : matrix.entries) {
      hash.add(static_cast<std::uint64_t>(entry.row));
      hash.add(static_cast<std::uint64_t>(entry.column));
      hash.add(entry.value);
    }
    key[k] = hash.value();
  }
  return key;
}

/// What a file begins with.
struct Header {
  std::uint64_t magic = kMagic;
  std::uint64_t version = kVersion;
  std::uint64_t size = 0;
  Key key{};
  std::uint64_t checksum = 0;
};

std::uint64_t checksumOf(const Modes& modes) {
  Hash hash(kMagic);
  for (Eigen::Index i = 0; i < modes.values.size(); ++i) {
    hash.add(modes.values[i]);
  }
  for (Eigen::Index i = 0; i < modes.vectors.size(); ++i) {
    hash.add(modes.vectors.data()[i]);
  }
  return hash.value();
}

template <class T>
bool readNumbers(std::istream& from, T* to, std::size_t count) {
  return static_cast<bool>(
      from.read(reinterpret_cast<char*>(to), static_cast<std::streamsize>(count * sizeof(T))));
}

template <class T>
void writeNumbers(std::ostream& to, const T* from, std::size_t count) {
  to.write(reinterpret_cast<const char*>(from), static_cast<std::streamsize>(count * sizeof(T)));
}

/// \return null if the file does not hold these modes whole
std::shared_ptr<const Modes> load(const fs::path& file, const Key& key, int size) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    return nullptr;
  }
  std::ifstream from(file, std::ios::binary);
  Header header;
  if (!readNumbers(from, &header, 1) || header.magic != kMagic || header.version != kVersion ||
      header.key != key || header.size != static_cast<std::uint64_t>(size)) {
    return nullptr;
  }
  auto modes = std::make_shared<Modes>();
  modes->values.resize(size);
  modes->vectors.resize(size, size);
  const bool is_whole = readNumbers(from, modes->values.data(), header.size) &&
                        readNumbers(from, modes->vectors.data(), header.size * header.size) &&
                        from.peek() == std::ifstream::traits_type::eof() &&
                        checksumOf(*modes) == header.checksum;
  return is_whole ? modes : nullptr;
}

/// A reader sees the old file or the new one, never half of it.
bool save(const fs::path& file, const Key& key, const Modes& modes) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  fs::path draft = file;
  draft += "." + std::to_string(getpid());
  Header header;
  header.size = static_cast<std::uint64_t>(modes.values.size());
  header.key = key;
  header.checksum = checksumOf(modes);
  {
    std::ofstream to(draft, std::ios::binary);
    writeNumbers(to, &header, 1);
    writeNumbers(to, modes.values.data(), header.size);
    writeNumbers(to, modes.vectors.data(), header.size * header.size);
    to.flush();
    if (!to) {
      fs::remove(draft, error);
      return false;
    }
  }
  fs::rename(draft, file, error);
  return !error;
}

std::shared_ptr<const Modes> solve(const ModalMatrix& matrix) {
  Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(matrix.size, matrix.size);
  for (const ModalMatrix::Entry& entry : matrix.entries) {
    lower(entry.row, entry.column) = entry.value;
  }
  const algebra::SymmetricModes found = algebra::symmetricModes(lower);
  if (!found.converged) {
    throw Exception("the modes of " + std::to_string(matrix.size) + " modules do not converge");
  }
  auto modes = std::make_shared<Modes>();
  modes->values = found.values;
  modes->vectors = found.vectors;
  return modes;
}

std::string variable(const char* name) {
  const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
  return value == nullptr ? "" : value;
}

fs::path fileOf(const Key& key) {
  const fs::path folder = modeCacheFolder();
  if (folder.empty()) {
    return {};
  }
  std::ostringstream name;
  name << std::hex << std::setfill('0') << std::setw(16) << key[0] << std::setw(16) << key[1];
  return folder / (name.str() + ".bin");
}

}  // namespace

fs::path modeCacheFolder() {
  if (variable("ERGOTIC_MODE_CACHE") == "off") {
    return {};
  }
  const std::string cache = variable("XDG_CACHE_HOME");
  const std::string home = variable("HOME");
  if (cache.empty() && home.empty()) {
    return {};
  }
  return (cache.empty() ? fs::path(home) / ".cache" : fs::path(cache)) / "ergotic" / "modes";
}

fs::path modeCacheFile(const ModalMatrix& matrix) {
  return fileOf(keyOf(matrix));
}

std::shared_ptr<const Modes> modesOf(const ModalMatrix& matrix, std::vector<std::string>& notes) {
  const Key key = keyOf(matrix);
  const fs::path file = fileOf(key);
  std::error_code error;
  if (!file.empty() && fs::exists(file, error)) {
    if (std::shared_ptr<const Modes> modes = load(file, key, matrix.size)) {
      return modes;
    }
    notes.push_back(file.string() +
                    ": warning: damaged or not a file of modes of this version: worked out again");
  }
  std::shared_ptr<const Modes> modes = solve(matrix);
  if (!file.empty() && !save(file, key, *modes)) {
    notes.push_back(file.string() + ": warning: cannot be written: the next load will be slow too");
  }
  return modes;
}

}  // namespace ergotic::physics
