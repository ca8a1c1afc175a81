// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QTreeWidget>
#include <functional>
#include <string>
#include <vector>

#include <ergotic/Takes.h>

namespace ergotic::panel {

/// The takes that there are, with star, length, instrument and date. Return plays the chosen one,
/// F2 renames it, Space stars it and Delete throws it away; so does the menu of the right button.
class TakeList : public QTreeWidget {
 public:
  /// Callbacks for a player's requests.
  struct Acts {
    std::function<void(const std::string& name)> play;
    std::function<void(const std::string& name, const std::string& new_name)> rename;
    std::function<void(const std::string& name, bool is_starred)> star;
    std::function<void(const std::string& name)> discard;
  };
  TakeList(Acts acts, QWidget* parent);

  /// Shows the takes; selects a new take if there is one, and keeps the selection otherwise.
  void show(const Takes& takes);
  /// \return name of the one that is chosen; empty: there is none
  std::string chosen() const;

 private:
  void addAct(const QString& text,
              const QList<QKeySequence>& keys,
              const std::function<void()>& act);
  bool isShown(const Takes& takes) const;
  void fill(const Takes& takes);
  bool isStarred() const;

  Acts acts_;
  Takes shown_;
  bool fills_ = false;  // items are changed by us
};

}  // namespace ergotic::panel
