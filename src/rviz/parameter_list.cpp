// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/parameter_list.hpp"

#include <QAction>
#include <QGridLayout>
#include <QVBoxLayout>
#include <QWheelEvent>
#include <utility>

#include "rviz/widgets.hpp"

namespace ergotic::panel {
namespace {

constexpr double kPeriodS = 1.0 / 30.0;  // between two values of one parameter
// For so long after the player's last move the station may still tell of earlier ones.
constexpr double kOwnS = 0.5;
constexpr int kKeyStep = SliderScale::kSteps / 100;
constexpr int kEndWidth = 58;

QLabel* small(const QString& text, Qt::Alignment alignment) {
  auto* label = adopted<QLabel>(text);
  QFont font = label->font();
  font.setPointSizeF(0.8 * font.pointSizeF());
  label->setFont(font);
  label->setAlignment(alignment | Qt::AlignVCenter);
  label->setFixedWidth(kEndWidth);
  return label;
}

QString number(double value) {
  return QString::fromStdString(numberText(value));
}

/// A wheel that passes by scrolls the list; it plays only the slider that the keyboard plays.
class Slider : public QSlider {
 public:
  Slider() : QSlider(Qt::Horizontal) {}

 protected:
  void wheelEvent(QWheelEvent* event) override {
    if (hasFocus()) {
      QSlider::wheelEvent(event);
    } else {
      event->ignore();
    }
  }
};

}  // namespace

ParameterRow::ParameterRow(const Parameters& parameters,
                           std::size_t index,
                           const std::function<void(const std::string&)>& learn,
                           QWidget* parent)
    : QWidget(parent),
      name_(parameters.names[index]),
      default_(parameters.defaults[index]),
      unit_(QString::fromStdString(parameters.units[index])),
      scale_(parameters.lows[index], parameters.highs[index]),
      throttle_(kPeriodS),
      value_(adopted<QLabel>()),
      slider_(adopted<Slider>()) {
  auto* grid = adopted<QGridLayout>(this);
  grid->setContentsMargins(2, 1, 2, 3);
  grid->setHorizontalSpacing(4);
  grid->setVerticalSpacing(0);
  auto* name = adopted<QLabel>(QString::fromStdString(name_));
  value_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  value_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  grid->addWidget(name, 0, 0, 1, 2);
  grid->addWidget(value_, 0, 2);
  grid->addWidget(makeSlider(parameters, index), 1, 0, 1, 3);
  setToolTip(QString("%1: %2 to %3 %4, at first %5")
                 .arg(QString::fromStdString(name_), number(parameters.lows[index]),
                      number(parameters.highs[index]), unit_, number(default_)));
  offerToLearn(learn);
}

/// Adds a context menu to the row, by right click on the name, the value or the slider.
void ParameterRow::offerToLearn(const std::function<void(const std::string&)>& learn) {
  auto* action = adopted<QAction>("Learn a MIDI controller", this);
  QObject::connect(action, &QAction::triggered, this, [this, learn] { learn(name_); });
  addAction(action);
  setContextMenuPolicy(Qt::ActionsContextMenu);
  value_->setContextMenuPolicy(Qt::NoContextMenu);  // its own offers to copy what is marked
}

QWidget* ParameterRow::makeSlider(const Parameters& parameters, std::size_t index) {
  slider_->setRange(0, SliderScale::kSteps);
  slider_->setSingleStep(kKeyStep);
  slider_->setPageStep(10 * kKeyStep);
  slider_->setAccessibleName(QString::fromStdString(name_));
  QObject::connect(slider_, &QSlider::valueChanged, this, [this](int step) {
    if (!follows_) {
      set(scale_.valueAt(step));
    }
  });
  auto* line = adopted<QWidget>();
  auto* layout = adopted<QHBoxLayout>(line);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  layout->addWidget(small(number(parameters.lows[index]), Qt::AlignRight));
  layout->addWidget(slider_, 1);
  layout->addWidget(small(number(parameters.highs[index]), Qt::AlignLeft));
  return line;
}

void ParameterRow::set(double value) {
  show(value);
  throttle_.offer(value);
  was_moved_ = true;
}

void ParameterRow::show(double value) {
  value_->setText(number(value) + (unit_.isEmpty() ? "" : " " + unit_));
}

void ParameterRow::follow(double value, double now_s) {
  if (slider_->isSliderDown() || was_moved_ || now_s < moved_s_ + kOwnS) {
    return;
  }
  show(value);
  follows_ = true;
  slider_->setValue(scale_.stepAt(value));
  follows_ = false;
}

void ParameterRow::toDefault() {
  follows_ = true;
  slider_->setValue(scale_.stepAt(default_));
  follows_ = false;
  set(default_);  // exactly, which a slider may not have
}

std::optional<double> ParameterRow::take(double now_s) {
  const std::optional<double> value = throttle_.take(now_s);
  if (value) {
    moved_s_ = now_s;
    was_moved_ = false;
  }
  return value;
}

ParameterList::ParameterList(std::function<void(const std::string&)> learn, QWidget* parent)
    : QScrollArea(parent), learn_(std::move(learn)) {
  setWidgetResizable(true);
  setFrameShape(QFrame::StyledPanel);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  rebuild();
}

bool ParameterList::isShown(const Parameters& parameters) const {
  return parameters.names == shown_.names && parameters.lows == shown_.lows &&
         parameters.highs == shown_.highs && parameters.units == shown_.units &&
         parameters.defaults == shown_.defaults;
}

void ParameterList::rebuild() {
  auto* inside = adopted<QWidget>();
  auto* layout = adopted<QVBoxLayout>(inside);
  layout->setContentsMargins(2, 2, 2, 2);
  layout->setSpacing(0);
  rows_.clear();
  for (std::size_t i = 0; i < shown_.names.size(); ++i) {
    rows_.push_back(adopted<ParameterRow>(shown_, i, learn_, inside));
    layout->addWidget(rows_.back());
  }
  if (rows_.empty()) {
    auto* none = adopted<QLabel>("There are no parameters.");
    none->setEnabled(false);
    layout->addWidget(none);
  }
  layout->addStretch(1);
  setWidget(inside);  // the one before is gone
}

void ParameterList::follow(const Parameters& parameters, double now_s) {
  if (!isShown(parameters)) {
    shown_ = parameters;
    rebuild();
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    rows_[i]->follow(parameters.values[i], now_s);
  }
}

void ParameterList::toDefaults() {
  for (ParameterRow* row : rows_) {
    row->toDefault();
  }
}

void ParameterList::send(const std::function<void(const std::string&, double)>& send,
                         double now_s) {
  for (ParameterRow* row : rows_) {
    if (const std::optional<double> value = row->take(now_s)) {
      send(row->name(), *value);
    }
  }
}

void ParameterList::takeFocus() {
  if (!rows_.empty()) {
    rows_.front()->slider()->setFocus(Qt::ShortcutFocusReason);
    ensureWidgetVisible(rows_.front());
  }
}

}  // namespace ergotic::panel
