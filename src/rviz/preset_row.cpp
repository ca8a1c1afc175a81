// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/preset_row.hpp"

#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QVBoxLayout>
#include <QWheelEvent>
#include <algorithm>
#include <utility>

#include "rviz/widgets.hpp"

namespace ergotic::panel {
namespace {

constexpr double kLongestMorphS = 60.0;
constexpr double kUsualMorphS = 2.0;
constexpr int kLongestName = 64;

/// A wheel that passes by chooses nothing.
class PresetChooser : public QComboBox {
 protected:
  void wheelEvent(QWheelEvent* event) override { event->ignore(); }
};

}  // namespace

PresetRow::PresetRow(Acts acts, QWidget* parent)
    : QWidget(parent),
      acts_(std::move(acts)),
      names_(adopted<PresetChooser>()),
      seconds_(adopted<QDoubleSpinBox>()),
      recall_(addButton("Recall", "Moves all parameters to the preset, within the time beside it")),
      keep_(addButton("Keep", "Keeps the present values of all parameters under this name")),
      undo_(addButton("Undo", "Brings back the values before the last change (Ctrl+Z)")) {
  names_->setEditable(true);
  names_->setInsertPolicy(QComboBox::NoInsert);
  names_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  names_->setAccessibleName("presets");
  names_->lineEdit()->setPlaceholderText("choose or name a preset");
  names_->lineEdit()->setMaxLength(kLongestName);
  seconds_->setRange(0.0, kLongestMorphS);
  seconds_->setDecimals(1);
  seconds_->setSuffix(" s");
  seconds_->setValue(kUsualMorphS);
  seconds_->setAccessibleName("morph time");
  seconds_->setToolTip("Time in which the parameters move to the preset; 0: at once");
  const auto recall = [this] { acts_.recall(name(), seconds_->value()); };
  QObject::connect(recall_, &QPushButton::clicked, this, recall);
  QObject::connect(names_->lineEdit(), &QLineEdit::returnPressed, recall_,
                   [this] { recall_->click(); });
  QObject::connect(keep_, &QPushButton::clicked, this, [this] { acts_.keep(name()); });
  QObject::connect(undo_, &QPushButton::clicked, this, [this] { acts_.undo(); });

  auto* label = adopted<QLabel>("Presets");
  QFont font = label->font();
  font.setBold(true);
  label->setFont(font);
  auto* above = adopted<QHBoxLayout>();
  above->addWidget(label);
  above->addWidget(names_, 1);
  auto* below = adopted<QHBoxLayout>();
  below->addWidget(recall_, 1);
  below->addWidget(seconds_);
  below->addWidget(keep_, 1);
  below->addWidget(undo_, 1);
  auto* rows = adopted<QVBoxLayout>(this);
  rows->setContentsMargins(0, 0, 0, 0);
  rows->setSpacing(4);
  rows->addLayout(above);
  rows->addLayout(below);
  show({}, false);
}

QPushButton* PresetRow::addButton(const QString& text, const QString& tip) {
  auto* button = adopted<QPushButton>(text);
  button->setToolTip(tip);
  button->setAutoDefault(false);
  button->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);  // they share what there is
  return button;
}

/// Shows the presets; text that somebody has entered stays until another scene plays.
void PresetRow::show(const Presets& presets, bool is_known) {
  if (presets.scene != scene_ || presets.names != shown_) {
    const QString written = presets.scene == scene_ ? names_->currentText() : QString();
    scene_ = presets.scene;
    shown_ = presets.names;
    names_->clear();
    for (const std::string& each : shown_) {
      names_->addItem(QString::fromStdString(each));
    }
    names_->setCurrentIndex(-1);
    names_->setEditText(written);
  }
  const bool plays = is_known && !scene_.empty();
  const bool is_kept = std::find(shown_.begin(), shown_.end(), name()) != shown_.end();
  names_->setEnabled(plays);
  seconds_->setEnabled(plays);
  keep_->setEnabled(plays && !name().empty());
  recall_->setEnabled(plays && is_kept);
  undo_->setEnabled(plays && presets.can_undo != 0U);
}

void PresetRow::takeFocus() {
  names_->setFocus(Qt::ShortcutFocusReason);
  names_->lineEdit()->selectAll();
}

}  // namespace ergotic::panel
