// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QWidget>
#include <vector>

#include <ergotic/Scope.h>

namespace ergotic::panel {

/// The wave of each output, from a rise through zero on, and beside it its spectrum by the
/// logarithm of the frequency. Thread: of the window
class ScopeWidget : public QWidget {
 public:
  explicit ScopeWidget(QWidget* parent);

  /// \param sound  null: nothing is known
  void show(const Scope::ConstPtr& sound);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  std::vector<float> channelOf(std::size_t channel) const;
  void paintWaves(QPainter& painter, const QRect& box) const;
  void paintSpectra(QPainter& painter, const QRect& box) const;

  Scope::ConstPtr sound_;
  std::size_t frames_ = 0;  // of each channel
};

}  // namespace ergotic::panel
