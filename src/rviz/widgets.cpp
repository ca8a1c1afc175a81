// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/widgets.hpp"

#include <QPainter>
#include <QPainterPath>
#include <QTextLayout>
#include <algorithm>
#include <cmath>

#include "rviz/volume_scale.hpp"

namespace ergotic::panel {
namespace {

constexpr int kLampHeight = 66;
constexpr int kMeterHeight = 80;
constexpr int kSoundHeight = 18;
constexpr double kNearFullScale = 0.98;  // from here on the limiter works
constexpr double kNearLimit = 0.8;       // of the limit: from here on a bar warns
const QColor kWarning(0xcc, 0x22, 0x22);
const QColor kForce(0x28, 0x74, 0xc8);
const QColor kSound(0x2f, 0x9e, 0x5b);

/// Draws words that wrap; the last line that fits ends with dots if there is more.
void drawWords(QPainter& painter, const QRect& box, const QString& text) {
  const QFontMetrics metrics(painter.font());
  QTextLayout layout(QString(text).replace('\n', QChar::LineSeparator), painter.font());
  layout.beginLayout();
  for (int y = box.top();; y += metrics.lineSpacing()) {
    QTextLine line = layout.createLine();
    if (!line.isValid()) {
      break;
    }
    line.setLineWidth(box.width());
    if (y + 2 * metrics.lineSpacing() > box.bottom() + 2) {
      const QString rest = text.mid(line.textStart()).replace('\n', ' ');
      painter.drawText(QPoint(box.left(), y + metrics.ascent()),
                       metrics.elidedText(rest, Qt::ElideRight, box.width()));
      break;
    }
    line.draw(&painter, QPointF(box.left(), y));
  }
  layout.endLayout();
}

/// Three digits at most: "0.04", "7.3", "19".
QString newtonsText(double newtons) {
  return QString::number(newtons, 'f', newtons < 0.995 ? 2 : newtons < 9.95 ? 1 : 0);
}

QFont scaled(QFont font, double factor, bool bold) {
  font.setPointSizeF(font.pointSizeF() * factor);
  font.setBold(bold);
  return font;
}

QPolygonF polygon(const QRectF& box, const std::vector<std::pair<double, double>>& corners) {
  QPolygonF points;
  for (const auto& [x, y] : corners) {
    points << QPointF(box.left() + x * box.width(), box.top() + y * box.height());
  }
  return points;
}

/// A sign of a few strokes in the middle of a shape, in the colour behind it.
void drawLetter(QPainter& painter, const QRectF& box, const QString& letter) {
  painter.setFont(scaled(painter.font(), 1.5, true));
  painter.drawText(box, Qt::AlignCenter, letter);
}

void drawRing(QPainter& painter, const QRectF& box) {
  painter.setBrush(Qt::NoBrush);
  painter.drawEllipse(box.adjusted(2, 2, -2, -2));
}

/// The shape in the colour of the pen, what is in it in `behind`.
void drawShape(QPainter& painter, const QRectF& box, Lamp lamp, const QColor& behind) {
  const QColor colour = painter.pen().color();
  painter.setBrush(colour);
  painter.setPen(QPen(colour, 4.0, Qt::SolidLine, Qt::RoundCap, Qt::MiterJoin));
  switch (lamp) {
    case Lamp::kStale:
      drawRing(painter, box);
      return drawLetter(painter, box, "?");
    case Lamp::kDisconnected:
      drawRing(painter, box);
      return painter.drawLine(polygon(box, {{0.2, 0.8}, {0.8, 0.2}}).at(0),
                              polygon(box, {{0.2, 0.8}, {0.8, 0.2}}).at(1));
    case Lamp::kReady:
      return painter.drawRect(box.adjusted(5, 5, -5, -5));
    case Lamp::kEngaging:
      painter.drawPolygon(polygon(box, {{0.05, 0.9}, {0.95, 0.9}, {0.95, 0.1}}));
      return;
    case Lamp::kUncalibrated:
      painter.drawPolygon(polygon(box, {{0.05, 0.92}, {0.5, 0.06}, {0.95, 0.92}}));
      painter.setPen(behind);
      return drawLetter(painter, box.adjusted(0, 8, 0, 0), "!");
    case Lamp::kPlaying:
      painter.drawEllipse(box);
      painter.setPen(Qt::NoPen);
      painter.setBrush(behind);
      painter.drawPolygon(polygon(box, {{0.36, 0.24}, {0.36, 0.76}, {0.8, 0.5}}));
      return;
    case Lamp::kFault:
      painter.drawPolygon(polygon(box, {{0.3, 0.02},
                                        {0.7, 0.02},
                                        {0.98, 0.3},
                                        {0.98, 0.7},
                                        {0.7, 0.98},
                                        {0.3, 0.98},
                                        {0.02, 0.7},
                                        {0.02, 0.3}}));
      painter.setPen(QPen(behind, 5.0, Qt::SolidLine, Qt::RoundCap));
      painter.drawLine(box.topLeft() + QPointF(13, 13), box.bottomRight() - QPointF(13, 13));
      painter.drawLine(box.topRight() + QPointF(-13, 13), box.bottomLeft() + QPointF(13, -13));
      return;
  }
}

}  // namespace

Paragraph::Paragraph(int lines, QWidget* parent) : QWidget(parent) {
  setFixedHeight(lines * fontMetrics().lineSpacing() + 2);
  setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
}

void Paragraph::show(const std::string& text) {
  show(text, false);
}

void Paragraph::show(const std::string& text, bool warns) {
  const QString words = QString::fromStdString(text);
  if (words != text_ || warns != warns_) {
    text_ = words;
    warns_ = warns;
    setToolTip(text_);
    update();
  }
}

void Paragraph::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.setPen(warns_ ? kWarning : palette().color(QPalette::WindowText));
  const int line = text_.indexOf('\n');
  const QString more = " (the rest appears under the mouse)";
  drawWords(painter, rect().adjusted(0, 1, 0, 0), line < 0 ? text_ : text_.left(line) + more);
}

LampWidget::LampWidget(QWidget* parent) : QWidget(parent) {
  setFixedHeight(kLampHeight);
  setAccessibleName("state of force");
}

void LampWidget::show(Lamp lamp, const std::string& reason) {
  const QString words = QString::fromStdString(reason);
  if (lamp != lamp_ || words != reason_) {
    lamp_ = lamp;
    reason_ = words;
    setToolTip(QString(wordOf(lamp)) + ": " + reason_);
    setAccessibleDescription(toolTip());
    update();
  }
}

void LampWidget::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QColor behind(colourOf(lamp_));
  const QColor ink = qGray(behind.rgb()) > 125 ? Qt::black : Qt::white;
  painter.setPen(Qt::NoPen);
  painter.setBrush(behind);
  painter.drawRoundedRect(rect(), 6, 6);
  painter.setPen(ink);
  painter.save();
  drawShape(painter, QRectF(12, 12, kLampHeight - 24, kLampHeight - 24), lamp_, behind);
  painter.restore();

  const QFont usual = painter.font();
  const QRect words(kLampHeight + 2, 4, width() - kLampHeight - 8, height() - 8);
  painter.setFont(scaled(usual, 1.6, true));
  const int line = QFontMetrics(painter.font()).height();
  painter.drawText(words, Qt::AlignLeft | Qt::AlignTop, wordOf(lamp_));
  painter.setFont(usual);
  drawWords(painter, words.adjusted(0, line, 0, 0), reason_);
}

ForceMeter::ForceMeter(QWidget* parent) : QWidget(parent) {
  setFixedHeight(kMeterHeight);
}

void ForceMeter::show(const std::vector<double>& forces,
                      const std::vector<double>& peaks,
                      double limit,
                      bool is_known) {
  if (forces == forces_ && peaks == peaks_ && limit == limit_ && is_known == is_known_) {
    return;
  }
  forces_ = forces;
  peaks_ = peaks;
  limit_ = limit;
  is_known_ = is_known && !forces.empty() && peaks.size() == forces.size();
  update();
}

void ForceMeter::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.fillRect(rect(), palette().color(QPalette::Base));
  painter.setFont(scaled(font(), 0.8, false));
  if (!is_known_) {
    painter.setPen(palette().color(QPalette::Disabled, QPalette::Text));
    painter.drawText(rect(), Qt::AlignCenter, "No forces are heard.");
    return;
  }
  const int count = static_cast<int>(forces_.size());
  for (int slice = 0; slice < count; ++slice) {
    const int left = width() * slice / count;
    const int right = width() * (slice + 1) / count;
    paintColumn(painter, QRect(left, 0, right - left, height()), static_cast<std::size_t>(slice));
  }
}

/// Paints a column, from above: newtons, a bar from the middle with marks at the peak, the number
/// of the slice.
void ForceMeter::paintColumn(QPainter& painter, const QRect& column, std::size_t slice) const {
  const int line = QFontMetrics(painter.font()).height();
  const QRect track = column.adjusted(2, line + 1, -2, -line - 1);
  const int middle = track.center().y();
  const auto height_of = [&](double newtons) {
    const double share = limit_ > 0.0 ? std::clamp(newtons / limit_, -1.0, 1.0) : 0.0;
    return static_cast<int>(std::lround(share * (track.height() / 2.0)));
  };
  const double peak = peaks_[slice];
  const bool warns = peak >= kNearLimit * limit_;
  const QColor colour = warns ? kWarning : kForce;
  const int tip = middle - height_of(forces_[slice]);
  painter.fillRect(track, palette().color(QPalette::AlternateBase));
  painter.fillRect(QRect(QPoint(track.left(), std::min(middle, tip)),
                         QPoint(track.right(), std::max(middle, tip))),
                   colour);
  painter.setPen(colour);
  for (const int y : {middle - height_of(peak), middle + height_of(peak)}) {
    painter.drawLine(track.left(), y, track.right(), y);
  }
  painter.setPen(palette().color(QPalette::Mid));
  painter.drawRect(track.adjusted(0, 0, -1, -1));

  const auto write = [&](const QRect& box, const QString& text) {
    if (QFontMetrics(painter.font()).horizontalAdvance(text) <= box.width()) {
      painter.drawText(box, Qt::AlignCenter, text);  // else there are too many slices for numbers
    }
  };
  painter.setPen(warns ? kWarning : palette().color(QPalette::Text));
  write(QRect(column.left(), 0, column.width(), line), newtonsText(peak));
  painter.setPen(palette().color(QPalette::Text));
  write(QRect(column.left(), height() - line, column.width(), line),
        QString::number(static_cast<int>(slice)));
}

SoundMeter::SoundMeter(QWidget* parent) : QWidget(parent) {
  setFixedHeight(kSoundHeight);
  setAccessibleName("loudness of the outputs");
}

void SoundMeter::show(const std::vector<double>& levels,
                      const std::vector<double>& peaks,
                      bool is_known) {
  if (levels == levels_ && peaks == peaks_ && is_known == is_known_) {
    return;
  }
  levels_ = levels;
  peaks_ = peaks;
  is_known_ = is_known && !levels.empty() && peaks.size() == levels.size();
  update();
}

void SoundMeter::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.fillRect(rect(), palette().color(QPalette::Base));
  painter.setFont(scaled(font(), 0.8, false));
  if (!is_known_) {
    painter.setPen(palette().color(QPalette::Disabled, QPalette::Text));
    painter.drawText(rect(), Qt::AlignCenter, "No sound is heard.");
    return;
  }
  const int count = static_cast<int>(levels_.size());
  for (int i = 0; i < count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const int top = height() * i / count;
    const int thickness = std::max(height() * (i + 1) / count - top - 1, 1);
    const auto length_of = [&](double level) {
      return static_cast<int>(std::lround(shareOfDecibels(level) * width()));
    };
    const QColor colour = peaks_[index] >= kNearFullScale ? kWarning : kSound;
    painter.fillRect(QRect(0, top, length_of(levels_[index]), thickness), colour);
    const int peak = length_of(peaks_[index]);
    painter.fillRect(QRect(std::max(peak - 2, 0), top, 2, thickness), colour.darker());
  }
}

}  // namespace ergotic::panel
