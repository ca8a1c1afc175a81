// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QPushButton>
#include <QWidget>
#include <functional>
#include <string>
#include <vector>

#include <ergotic/Presets.h>

#include "rviz/words.hpp"

namespace ergotic::panel {

/// The presets of the scene that plays: one is chosen or named, kept, or recalled within some
/// seconds; the last change of parameters is undone.
class PresetRow : public QWidget {
 public:
  /// Callbacks for a player's requests.
  struct Acts {
    std::function<void(const std::string& name)> keep;
    std::function<void(const std::string& name, double seconds)> recall;
    std::function<void()> undo;
  };
  PresetRow(Acts acts, QWidget* parent);

  /// \param is_known  false: disables all requests
  void show(const Presets& presets, bool is_known);
  void undo() { undo_->click(); }
  /// The keyboard names a preset from now on.
  void takeFocus();

 private:
  QPushButton* addButton(const QString& text, const QString& tip);
  std::string name() const { return nameText(names_->currentText().toStdString()); }

  Acts acts_;
  std::string scene_;               // as it is shown
  std::vector<std::string> shown_;  // names
  QComboBox* names_;
  QDoubleSpinBox* seconds_;
  QPushButton* recall_;
  QPushButton* keep_;
  QPushButton* undo_;
};

}  // namespace ergotic::panel
