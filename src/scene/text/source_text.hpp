// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

/// Bytes that a text may contain.
enum class Bytes {
  kUtf8,  ///< UTF-8 everywhere
  kAny,   ///< anything but control characters: old files have Latin-1 comments
};

/// Refuses what no scene text may hold: more than 64 MB, NUL and other control characters (tab and
/// line ends excepted), and bytes that are not UTF-8 if these are not allowed.
/// \param first_line  number of the line with which the text begins
/// \throws TextError at the first such byte
void checkBytes(const std::string& text,
                const std::string& file,
                Bytes allowed,
                int first_line = 1);

/// Says of a text that has two bytes for each letter what it is and how to save it. checkBytes does
/// so, too. \throws TextError
void refuseUtf16(const std::string& text, const std::string& file);

/// Offset of the first byte that is not part of a well-formed UTF-8 character, npos if there is
/// none.
std::size_t findNonUtf8(const std::string& text);

/// Line and column (in bytes) of an offset, both from 1.
Place placeAt(const std::string& text, std::size_t offset);

/// Length of the UTF-8 byte order mark at the start of the text, 0 if there is none.
std::size_t byteOrderMark(const std::string& text);

/// A path as it stands in a file: relative ones start where the file is.
std::string besideFile(const std::string& path, const std::string& file);
/// `dir/harp.mdl` -> `harp`
std::string stemOf(const std::string& file);

}  // namespace ergotic::scene
