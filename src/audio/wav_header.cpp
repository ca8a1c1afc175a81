// SPDX-License-Identifier: BSD-3-Clause
#include "audio/wav_header.hpp"

#include <algorithm>
#include <istream>

namespace ergotic::audio {
namespace {

constexpr unsigned kPcm = 1;
constexpr unsigned kFloatTag = 3;
constexpr unsigned kExtensible = 0xFFFE;
constexpr std::uint64_t kUnknown = 0xFFFFFFFF;  // what 32 bits cannot say
constexpr int kMaxPlainChannels = 2;
constexpr int kFormBytes = 12;
constexpr int kChunkHead = 8;
constexpr int kMaxChunks = 1000;  // before the samples
constexpr std::size_t kDs64Bytes = 28;
/// End of the identifiers of extensible formats, after the tag.
constexpr char kGuidEnd[] = "\x00\x00\x00\x00\x10\x00\x80\x00\x00\xAA\x00\x38\x9B\x71";

void put(std::string& bytes, std::uint64_t number, int width) {
  for (int i = 0; i < width; ++i) {
    bytes += static_cast<char>(number >> (8 * i) & 0xFFU);
  }
}

std::string numberOf(std::uint64_t number, int width) {
  std::string bytes;
  put(bytes, number, width);
  return bytes;
}

std::uint64_t numberAt(const std::string& bytes, std::size_t at, int width) {
  std::uint64_t number = 0;
  for (int i = 0; i < width; ++i) {
    const auto byte = static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]);
    number |= std::uint64_t{byte} << (8 * i);
  }
  return number;
}

void putChunk(std::string& bytes, const char* name, const std::string& content) {
  bytes += name;
  put(bytes, content.size(), 4);
  bytes += content;
}

std::string formatOf(const WavShape& shape) {
  const bool is_plain = shape.channels <= kMaxPlainChannels;
  const unsigned tag = shape.is_float ? kFloatTag : kPcm;
  const auto bits = static_cast<unsigned>(8 * shape.sample_bytes);
  const auto frame = static_cast<unsigned>(shape.frameBytes());
  std::string format;
  put(format, is_plain ? tag : kExtensible, 2);
  put(format, static_cast<unsigned>(shape.channels), 2);
  put(format, static_cast<unsigned>(shape.rate), 4);
  put(format, std::uint64_t{frame} * static_cast<unsigned>(shape.rate), 4);
  put(format, frame, 2);
  put(format, bits, 2);
  if (!is_plain) {
    put(format, 22, 2);  // bytes that follow
    put(format, bits, 2);
    put(format, 0, 4);  // the channels stand for no loudspeakers
    put(format, tag, 2);
    format.append(kGuidEnd, sizeof kGuidEnd - 1);
  } else if (shape.is_float) {
    put(format, 0, 2);
  }
  return format;
}

/// A chunk of a file, as its head says.
struct Chunk {
  std::string name;
  std::uint64_t size = 0;
  std::string start;  ///< its first 64 bytes, as far as they are there
};

std::optional<Chunk> chunkAt(std::istream& file, std::int64_t at) {
  constexpr std::size_t kMax = 64;
  constexpr std::size_t kHead = kChunkHead;
  std::string bytes(kHead + kMax, '\0');
  file.clear();
  file.seekg(at);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  const auto got = static_cast<std::size_t>(file.gcount());
  if (got < kHead) {
    return std::nullopt;
  }
  return Chunk{bytes.substr(0, 4), numberAt(bytes, 4, 4), bytes.substr(kHead, got - kHead)};
}

/// \return nothing if it is of another kind
std::optional<WavShape> shapeOf(const std::string& format) {
  if (format.size() < 16) {
    return std::nullopt;
  }
  const bool is_extensible = numberAt(format, 0, 2) == kExtensible && format.size() >= 26;
  const std::uint64_t tag = numberAt(format, is_extensible ? 24 : 0, 2);
  WavShape shape;
  shape.channels = static_cast<int>(numberAt(format, 2, 2));
  shape.rate = static_cast<int>(numberAt(format, 4, 4) & 0x7FFFFFFFU);
  shape.sample_bytes = static_cast<int>(numberAt(format, 14, 2) / 8);
  shape.is_float = tag == kFloatTag;
  const bool is_known = shape.is_float
                            ? shape.sample_bytes == 4 || shape.sample_bytes == 8
                            : tag == kPcm && shape.sample_bytes >= 1 && shape.sample_bytes <= 4;
  const bool is_whole = shape.channels > 0 && shape.rate > 0 &&
                        static_cast<std::uint64_t>(shape.frameBytes()) == numberAt(format, 12, 2);
  return is_known && is_whole ? std::optional(shape) : std::nullopt;
}

/// Bytes, as a header says them.
struct Sizes {
  std::uint64_t riff = 0;
  std::uint64_t data = 0;
};

/// \param begin  of the samples \param length  of the file
bool isUnfinished(const Sizes& sizes, std::int64_t begin, std::int64_t length) {
  const bool knows_the_end =
      sizes.riff != kUnknown && sizes.riff + kChunkHead >= static_cast<std::uint64_t>(length);
  return length > begin && (sizes.data == kUnknown || (sizes.data == 0 && !knows_the_end));
}

}  // namespace

std::int64_t wavPadding(const WavShape& shape, std::int64_t frames) {
  return frames * shape.frameBytes() % 2;
}

std::string wavHeader(const WavShape& shape, std::int64_t frames) {
  const bool is_known = frames != kUnknownFrames;
  const auto count = static_cast<std::uint64_t>(frames);
  const std::uint64_t data =
      is_known ? count * static_cast<unsigned>(shape.frameBytes()) : kUnknown;
  std::string format;
  putChunk(format, "fmt ", formatOf(shape));
  if (shape.is_float) {
    putChunk(format, "fact", numberOf(std::min(count, kUnknown), 4));
  }
  const std::uint64_t riff =
      kFormBytes + kDs64Bytes + 2 * kChunkHead + format.size() - kChunkHead + data + data % 2;
  const bool is_long = riff >= kUnknown;
  std::string header = is_long && is_known ? "RF64" : "RIFF";
  put(header, std::min(riff, kUnknown), 4);
  header += "WAVE";
  if (is_long && is_known) {
    putChunk(header, "ds64",
             numberOf(riff, 8) + numberOf(data, 8) + numberOf(count, 8) + numberOf(0, 4));
  }
  header += format;
  if (!(is_long && is_known)) {
    putChunk(header, "JUNK", std::string(kDs64Bytes, '\0'));  // room for ds64
  }
  header += "data";
  put(header, is_long ? kUnknown : data, 4);
  return header;
}

std::optional<UnfinishedWav> findUnfinished(std::istream& file) {
  file.seekg(0, std::ios::end);
  const std::int64_t length = file.tellg();
  const std::optional<Chunk> form = chunkAt(file, 0);
  if (!form || (form->name != "RIFF" && form->name != "RF64") ||
      form->start.compare(0, 4, "WAVE") != 0) {
    return std::nullopt;
  }
  Sizes sizes{form->size, kUnknown};
  std::optional<WavShape> shape;
  std::int64_t at = kFormBytes;
  std::optional<Chunk> chunk = chunkAt(file, at);
  for (int n = 0; n < kMaxChunks && chunk && chunk->name != "data"; ++n) {
    if (chunk->name == "fmt ") {
      shape = shapeOf(chunk->start);
    } else if (chunk->name == "ds64" && chunk->start.size() >= 16) {
      sizes = {numberAt(chunk->start, 0, 8), numberAt(chunk->start, 8, 8)};
    }
    at += kChunkHead + static_cast<std::int64_t>(chunk->size + chunk->size % 2);
    chunk = chunkAt(file, at);
  }
  if (!chunk || chunk->name != "data" || !shape) {
    return std::nullopt;
  }
  at += kChunkHead;
  sizes.data = chunk->size == kUnknown ? sizes.data : chunk->size;
  return isUnfinished(sizes, at, length)
             ? std::optional(UnfinishedWav{*shape, at, (length - at) / shape->frameBytes()})
             : std::nullopt;
}

}  // namespace ergotic::audio
