// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/scope_widget.hpp"

#include <QPainter>
#include <QPolygonF>
#include <algorithm>
#include <array>
#include <cmath>

#include "rviz/sound_view.hpp"

namespace ergotic::panel {
namespace {

constexpr int kScopeHeight = 96;
constexpr int kGap = 4;  // pixels between the two pictures
constexpr std::size_t kMinFrames = 16;
constexpr std::size_t kMaxChannels = 4;  // more would hide each other
constexpr float kMinPeak = 1e-4F;        // of full scale; what is softer is drawn small
const std::array<QColor, kMaxChannels> kColours = {
    QColor(0x2f, 0x9e, 0x5b), QColor(0xd9, 0x7a, 0x1e), QColor(0x28, 0x74, 0xc8),
    QColor(0xa0, 0x55, 0xb5)};

}  // namespace

ScopeWidget::ScopeWidget(QWidget* parent) : QWidget(parent) {
  setFixedHeight(kScopeHeight);
  setAccessibleName("waveform and spectrum of the outputs");
  setToolTip(
      "Left: the waves of the first four outputs, as large as they fit. Right: their spectra, "
      "30 Hz to 20 kHz, 0 to -90 dB; lines at 100 Hz, 1 kHz and 10 kHz.");
}

void ScopeWidget::show(const Scope::ConstPtr& sound) {
  if (sound == sound_) {
    return;
  }
  sound_ = sound;
  const std::size_t channels = sound ? sound->channels.size() : 0;
  frames_ = channels > 0 ? sound->samples.size() / channels : 0;
  update();
}

std::vector<float> ScopeWidget::channelOf(std::size_t channel) const {
  const auto first = sound_->samples.begin() + static_cast<std::ptrdiff_t>(channel * frames_);
  return {first, first + static_cast<std::ptrdiff_t>(frames_)};
}

void ScopeWidget::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.fillRect(rect(), palette().color(QPalette::Base));
  if (frames_ < kMinFrames) {
    painter.setPen(palette().color(QPalette::Disabled, QPalette::Text));
    painter.drawText(rect(), Qt::AlignCenter, "No sound is seen.");
    return;
  }
  painter.setRenderHint(QPainter::Antialiasing);
  const int half = (width() - kGap) / 2;
  paintWaves(painter, {0, 0, half, height()});
  paintSpectra(painter, {half + kGap, 0, width() - half - kGap, height()});
}

/// Paints all waves with one scale and one begin: that of the first channel.
void ScopeWidget::paintWaves(QPainter& painter, const QRect& box) const {
  painter.setPen(palette().color(QPalette::Mid));
  const double middle = 0.5 * box.height();
  painter.drawLine(QPointF(box.left(), middle), QPointF(box.right(), middle));
  const std::size_t shown = frames_ / 2;
  const std::size_t begin = beginOfWave(channelOf(0), shown);
  const std::size_t channels = std::min(sound_->channels.size(), kMaxChannels);
  float peak = kMinPeak;
  for (std::size_t i = 0; i < channels * frames_; ++i) {
    peak = std::max(peak, std::abs(sound_->samples[i]));
  }
  for (std::size_t c = channels; c-- > 0;) {
    QPolygonF line;
    for (std::size_t i = 0; i < shown; ++i) {
      const float sample = sound_->samples[c * frames_ + begin + i] / peak;
      const double x = box.left() + static_cast<double>(box.width()) * static_cast<double>(i) /
                                        static_cast<double>(shown);
      line << QPointF(x, middle - 0.95 * middle * static_cast<double>(sample));
    }
    painter.setPen(kColours[c]);
    painter.drawPolyline(line);
  }
}

void ScopeWidget::paintSpectra(QPainter& painter, const QRect& box) const {
  painter.setPen(palette().color(QPalette::Mid));
  for (const double hz : {1e2, 1e3, 1e4}) {
    const double x = box.left() + SpectrumScale::shareOf(hz) * box.width();
    painter.drawLine(QPointF(x, box.top()), QPointF(x, box.bottom()));
  }
  for (std::size_t c = std::min(sound_->channels.size(), kMaxChannels); c-- > 0;) {
    QPolygonF line;
    for (const double level : columnsOf(spectrumOf(channelOf(c)), sound_->rate, box.width())) {
      const double share = std::min(level / SpectrumScale::kLowestDb, 1.0);
      line << QPointF(box.left() + line.size(), std::max(share, 0.0) * (box.height() - 1));
    }
    painter.setPen(kColours[c]);
    painter.drawPolyline(line);
  }
}

}  // namespace ergotic::panel
