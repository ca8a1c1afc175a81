// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QLabel>
#include <QWidget>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rviz/words.hpp"

namespace ergotic::panel {

/// A new object of Qt, which its parent owns.
template <class T, class... Arguments>
T* adopted(Arguments&&... arguments) {
  return std::make_unique<T>(std::forward<Arguments>(arguments)...).release();
}

/// Words that wrap, in so many lines at most; what does not fit is in the tooltip.
class Paragraph : public QWidget {
 public:
  Paragraph(int lines, QWidget* parent);

  void show(const std::string& text);
  /// \param warns  in the colour of warnings
  void show(const std::string& text, bool warns);
  QString text() const { return text_; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QString text_;
  bool warns_ = false;
};

/// The state of force, as large as it is important: by shape, word and colour.
class LampWidget : public QWidget {
 public:
  explicit LampWidget(QWidget* parent);

  /// \param reason  one sentence
  void show(Lamp lamp, const std::string& reason);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  Lamp lamp_ = Lamp::kStale;
  QString reason_;
};

/// The force at each slice, up or down from zero, against the limit; and in numbers the largest of
/// the last second.
class ForceMeter : public QWidget {
 public:
  explicit ForceMeter(QWidget* parent);

  /// \param forces    [slices] N
  /// \param peaks     [slices] N, no less than 0
  /// \param limit     N
  /// \param is_known  else it is drawn without bars
  void show(const std::vector<double>& forces,
            const std::vector<double>& peaks,
            double limit,
            bool is_known);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void paintColumn(QPainter& painter, const QRect& column, std::size_t slice) const;

  std::vector<double> forces_;
  std::vector<double> peaks_;
  double limit_ = 0.0;
  bool is_known_ = false;
};

/// Level meter of the outputs, a bar each over 60 dB, with a mark at the peak of the last second.
class SoundMeter : public QWidget {
 public:
  explicit SoundMeter(QWidget* parent);

  /// \param levels    [outputs] relative to full scale
  /// \param peaks     [outputs] maxima of the last second
  /// \param is_known  false: it is drawn without bars
  void show(const std::vector<double>& levels, const std::vector<double>& peaks, bool is_known);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  std::vector<double> levels_;
  std::vector<double> peaks_;
  bool is_known_ = false;
};

}  // namespace ergotic::panel
