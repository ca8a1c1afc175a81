// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/scene/text/read_scene.hpp"
#include "support/test.hpp"

namespace ergotic::scene {

/// A text that must be refused: at the place of the marker `<!>`, which is not part of the text,
/// and with a message that holds `message`.
struct BadText {
  const char* text;
  const char* message;
};

inline void expectRefused(const BadText& bad, const std::string& name) {
  std::string text = bad.text;
  const std::size_t marker = text.find("<!>");
  ASSERT_NE(marker, std::string::npos) << bad.text;
  text.erase(marker, 3);
  int line = 1;
  int column = 1;
  for (std::size_t i = 0; i < marker; ++i) {
    line += text[i] == '\n' ? 1 : 0;
    column = text[i] == '\n' ? 1 : column + 1;
  }
  try {
    readScene(text, name);
    ADD_FAILURE() << "was not refused:\n" << bad.text;
  } catch (const TextError& e) {
    const std::string what = e.what();
    const std::string start =
        name + ":" + std::to_string(line) + ":" + std::to_string(column) + ": error: ";
    EXPECT_EQ(what.substr(0, start.size()), start) << what << "\n" << bad.text;
    EXPECT_NE(what.find(bad.message), std::string::npos) << what << "\n" << bad.text;
    EXPECT_EQ(e.line(), line);
    EXPECT_EQ(e.column(), column);
  }
}

}  // namespace ergotic::scene
